#include "dem/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "common/error.hpp"
#include "dem/checkpoint.hpp"
#include "dem/failure.hpp"
#include "dem/fragments.hpp"
#include "dem/guards.hpp"
#include "dem/history.hpp"
#include "dem/measures.hpp"
#include "dem/progress.hpp"
#include "dem/run_directory.hpp"
#include "dem/stages/generate.hpp"
#include "dem/stages/prepare.hpp"
#include "dem/stages/sample.hpp"
#include "dem/stages/shear.hpp"

namespace fs = std::filesystem;

namespace dem {
namespace {

constexpr int kPreparationInterval = 4000;  // steps between two checkpoints: a few seconds of work
constexpr int kPreparationGuards = 100;     // steps between two looks at its state

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A state and what steers it, from a checkpoint or fresh.
struct Start {
  State state;
  Control control;
};

Start fresh_start(const common::Scene& scene) {
  Start start;
  start.state.particles = generate_assembly(scene.assembly, scene.material.density, scene.seed);
  start.state.next_id = static_cast<std::int64_t>(start.state.particles.size());
  start.state.friction = scene.effects.friction ? scene.preparation.initial_friction : 0;
  return start;
}

class Run {
 public:
  Run(const common::Scene& scene, const RunOptions& options, const RunPorts& ports)
      : scene_(scene),
        options_(options),
        ports_(ports),
        hash_(common::config_hash(scene, common::UsedBy::dem)),
        directory_(options.directory, options.resume, [this](const std::string& text) { warn(text); }),
        is_replay_(is_failure(options.directory)),
        history_(scene) {}

  RunEnd operator()() {
    try {
      const RunEnd end = run();
      write_profile();
      return end;
    } catch (const common::Error& error) {
      if (error.code() != common::ExitCode::numerical_failure || !engine_) throw;
      throw common::numerical_failure(keep_failure(error));
    }
  }

 private:
  RunEnd run() {
    if (options_.resume) {
      if (std::optional<common::Frame> frame = directory_.newest_frame(hash_)) {
        write_case(RunDirectory::Existing::kept);
        return resume_shear(*frame);
      }
    }
    if (!scene_.preparation.from.empty()) {
      start_from_sample();
      // A refused sample leaves no trace; nothing else was made with a case.yaml that stands here.
      write_case(RunDirectory::Existing::replaced);
    } else if (const auto end = prepare()) {
      return *end;
    }
    for (const std::string& text : shortcomings_of(scene_, *engine_)) warn(text);
    Shear::begin(*engine_, control_);
    require_progress_to_the_end();
    record();
    const std::optional<RunEnd> end = write_frame_and_exchange();
    return end ? *end : shear();
  }

  // The case of a failure names its sample by a relative path, which a scene that was read no longer has.
  void write_case(RunDirectory::Existing existing) const {
    if (!is_replay_) directory_.write_case(scene_, existing);
  }

  void make_engine(State state) { engine_ = std::make_unique<Engine>(scene_, std::move(state), options_.threads); }

  // The sample of another run: its particles and contacts, this scene's laws and coefficients.
  void start_from_sample() {
    const common::Frame frame = read_sample(scene_);
    control_ = read_control(frame);
    make_engine(to_state(frame));
    checkpoint_ = scene_.preparation.from;
    engine_->edit().friction = scene_.effects.friction ? scene_.contact.friction : 0;
  }

  // Prepares a sample; nothing is returned when it is ready.
  std::optional<RunEnd> prepare() {
    const auto begin = Clock::now();
    std::int64_t checkpoint = -1;
    std::optional<common::Frame> found;
    if (options_.resume) {
      if (const auto sample = directory_.prepared_sample(hash_)) {
        write_case(RunDirectory::Existing::kept);
        take_sample(*sample);
        return std::nullopt;
      }
      found = directory_.newest_preparation(hash_, checkpoint);
    }
    // Without anything that was made with it, a case.yaml may be that of another scene.
    write_case(found ? RunDirectory::Existing::kept : RunDirectory::Existing::replaced);
    if (found) {
      control_ = read_control(*found);
      make_engine(to_state(*found));
      checkpoint_ = directory_.preparation(checkpoint);
    } else {
      Start start = fresh_start(scene_);
      control_ = start.control;
      make_engine(std::move(start.state));
    }
    require_progress(engine_->state(), kLongestPhase, scene_.guards.steps);
    Preparation preparation(scene_, *engine_, control_);
    while (control_.phase != Phase::shear) {
      preparation.step();
      const std::int64_t step = engine_->clock().step;
      if (step % 500 == 0) ports_.progress(preparation_event(scene_, *engine_, control_));
      if (step % kPreparationGuards == 0) guard_state();
      if (step % kPreparationInterval == 0 && control_.phase != Phase::shear) {
        checkpoint_ = directory_.preparation(++checkpoint);
        write_checkpoint(checkpoint_);
        directory_.drop_preparations_before(checkpoint);
        engine_->restart();
      }
      if (ports_.interrupted()) return RunEnd::interrupted;
    }
    control_.phase = Phase::hold;
    write_checkpoint(directory_.sample());
    seconds_["preparation"] += seconds_since(begin);
    // A sample read back is what other scenes start from, so this run starts from it as well.
    take_sample(common::read_frame(directory_.sample()));
    return std::nullopt;
  }

  void take_sample(const common::Frame& sample) {
    control_ = read_control(sample);
    make_engine(to_state(sample));
    checkpoint_ = directory_.sample();
  }

  void write_checkpoint(const fs::path& path) {
    guard_state();
    history_.record(*engine_, control_);
    common::Frame frame = snapshot();
    common::write_frame(path, frame, common::kDurable);
    if (!is_replay_) remove_failure(options_.directory);
  }

  // The checks of every instant.
  void guard_state() const {
    require_finite(engine_->clock().particles, engine_->forces());
    require_possible_contacts(engine_->state(), scene_.guards.overlap);
  }

  // A row of the history in shear, of a state that passes its checks.
  void record() {
    guard_state();
    history_.record(*engine_, control_);
    if (!scene_.effects.energy_ledger) return;
    require_balanced_energy(scene_, *engine_, control_, history_.last("energy_residual"),
                            history_.last("elastic_energy"));
  }

  void require_progress_to_the_end() const {
    const double strain = scene_.shear.axial_strain - control_.axial_strain();
    require_progress(engine_->clock(), strain / scene_.shear.strain_rate, scene_.guards.steps);
  }

  common::Frame snapshot() {
    common::Frame frame = to_frame(engine_->state(), scene_, stage_of(control_.phase));
    frame.frame = static_cast<std::int64_t>(control_.next_frame);
    frame.axial_strain = control_.axial_strain();
    frame.config_hash = hash_;
    frame.history = history_.take();
    for (common::Column& c : to_columns(control_)) frame.checkpoint.push_back(std::move(c));
    return frame;
  }

  RunEnd resume_shear(const common::Frame& frame) {
    control_ = read_control(frame);
    make_engine(to_state(frame));
    control_.next_frame = static_cast<double>(frame.frame + 1);
    checkpoint_ = directory_.frame(frame.frame);
    checkpoint_step_ = frame.step;
    if (frame.final) return RunEnd::finished;
    if (options_.until_frame && frame.frame >= *options_.until_frame) return RunEnd::paused;
    if (scene_.effects.breakage) {
      const fs::path split = directory_.split(frame.frame);
      if (!fs::exists(split)) {
        throw common::bad_input(fmt::format("{}: frame {} has no split; run `xfem solve` on {} first", split.string(),
                                            frame.frame, directory_.frame(frame.frame).string()));
      }
      apply(split, frame.payload_hash);
    }
    return shear();
  }

  RunEnd shear() {
    const auto begin = Clock::now();
    const double others_before = seconds_of_coupling();
    Shear shear_stage(scene_, *engine_, control_);
    for (;;) {
      while (!shear_stage.frame_due()) {
        shear_stage.step();
        if (engine_->clock().step % scene_.shear.history_interval == 0) record();
        if (ports_.interrupted()) return RunEnd::interrupted;
      }
      if (engine_->clock().step % scene_.shear.history_interval != 0) record();
      if (const auto end = write_frame_and_exchange()) {
        seconds_["shear"] += seconds_since(begin) - (seconds_of_coupling() - others_before);
        return *end;
      }
    }
  }

  // Writes frame `next_frame` and lets the breakage analysis answer; nothing is returned when the test goes on.
  std::optional<RunEnd> write_frame_and_exchange() {
    const Shear stage(scene_, *engine_, control_);
    const auto write_begin = Clock::now();
    common::Frame frame = snapshot();
    if (frame.frame > 0) {
      require_rest(scene_, frame.history, *engine_, frame.step - checkpoint_step_, split_share_);
      require_lateral_stress(scene_, frame.history);
    }
    frame.final = frame.frame >= stage.last_frame();
    ports_.progress(shear_event(scene_, *engine_, control_));
    const common::WrittenFile written =
        common::write_frame(directory_.frame(frame.frame), frame, scene_.output.durability);
    seconds_["write"] += seconds_since(write_begin);
    checkpoint_ = written.path;
    checkpoint_step_ = frame.step;
    split_.clear();
    split_share_ = 0;
    if (!is_replay_) remove_failure(options_.directory);  // the run got past it
    control_.next_frame += 1;
    engine_->restart();

    std::optional<std::string> split = std::string();
    if (ports_.exchange) {
      const auto begin = Clock::now();
      split = ports_.exchange(frame.frame, written);
      seconds_["exchange"] += seconds_since(begin);
      if (!split) return RunEnd::stopped;
    }
    if (frame.final) return RunEnd::finished;
    if (options_.until_frame && frame.frame >= *options_.until_frame) return RunEnd::paused;
    if (!split->empty()) {
      apply(*split, frame.payload_hash);
    } else if (scene_.effects.breakage && !ports_.exchange) {
      if (!fs::exists(directory_.split(frame.frame))) return RunEnd::paused;
      apply(directory_.split(frame.frame), frame.payload_hash);
    }
    return std::nullopt;
  }

  void apply(const fs::path& path, const std::string& frame_hash) {
    const auto begin = Clock::now();
    read_and_apply(path, frame_hash);
    seconds_["apply"] += seconds_since(begin);
  }

  void read_and_apply(const fs::path& path, const std::string& frame_hash) {
    const common::Split split = common::read_split(path);
    if (split.frame_hash != frame_hash) {
      throw common::bad_input(fmt::format("{}: answers a frame with payload hash {}, expected {}", path.string(),
                                          split.frame_hash, frame_hash));
    }
    split_ = path;
    split_share_ = static_cast<double>(split.broken.parent.size()) / static_cast<double>(split.particles.id.size());
    require_answers(scene_, split);
    if (split.broken.parent.empty()) return;
    const auto energy = [&] {
      return elastic_energy(engine_->state(), engine_->constants()) + engine_->kinetic_energy();
    };
    const double before = energy();
    const SplitReport report = apply_split(engine_->edit(), split, scene_.material.density);
    engine_->restart();
    share_inherited_history(engine_->edit(), report);
    engine_->restart();
    engine_->edit().energy.released_by_breakage += before - energy();
    control_.momentum_error = std::max(control_.momentum_error, report.momentum_error);
    control_.broken += report.broken;
    require_progress_to_the_end();
  }

  // Writes down what a guard found, and says it: the text names the place, the reason and what can be done.
  std::string keep_failure(const common::Error& error) {
    Failure failure;
    if (const auto* found = dynamic_cast<const NumericalFailure*>(&error)) {
      failure.finding = found->finding();
    } else {
      failure.finding = {"measure", error.what(), {}, {}};
    }
    const State& state = engine_->clock();
    failure.stage = name_of(control_.phase);
    failure.frame = static_cast<std::int64_t>(control_.next_frame) - (is_refusal(failure) ? 1 : 0);
    failure.step = state.step;
    failure.time = state.time;
    failure.axial_strain = control_.axial_strain();
    failure.checkpoint = checkpoint_;
    failure.split = split_;
    if (is_replay_) return place_and_reason(failure);
    return place_and_reason(failure) + keep_and_advise(options_.directory, scene_, failure, snapshot());
  }

  void warn(const std::string& text) const { ports_.progress(warning_event(text)); }

  // Seconds in shear that are not stepping.
  double seconds_of_coupling() { return seconds_["write"] + seconds_["exchange"] + seconds_["apply"]; }

  void write_profile() {
    if (options_.profile.empty()) return;
    nlohmann::ordered_json json{{"seconds", nlohmann::ordered_json::object()}};  // none if interrupted early
    for (const auto& [phase, seconds] : seconds_) json["seconds"][phase] = seconds;
    if (engine_) {
      json["counts"] = {{"steps", engine_->state().step}, {"contact_steps", engine_->contact_steps()}};
    }
    if (options_.profile == "-") {
      json["event"] = "profile";
      ports_.progress(json.dump());
      return;
    }
    const std::string text = json.dump(2) + "\n";
    common::write_atomically(options_.profile, std::as_bytes(std::span(text)), {});
  }

  const common::Scene& scene_;
  const RunOptions& options_;
  const RunPorts& ports_;
  std::string hash_;
  RunDirectory directory_;
  bool is_replay_;                    // in the directory that a failure has left
  fs::path checkpoint_;               // newest file that a run could go on from
  std::int64_t checkpoint_step_ = 0;  // of the newest frame
  fs::path split_;                    // applied since
  double split_share_ = 0;            // of the particles that it broke
  History history_;
  Control control_;
  std::unique_ptr<Engine> engine_;
  std::map<std::string, double> seconds_;
};

}  // namespace

RunEnd run(const common::Scene& scene, const RunOptions& options, const RunPorts& ports) {
  if (scene.output.keep_frames != 0) {
    throw common::bad_input(
        fmt::format("output.keep_frames: found {}, expected all: every frame holds a part of the history",
                    scene.output.keep_frames));
  }
  return Run(scene, options, ports)();
}

}  // namespace dem
