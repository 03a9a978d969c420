#include "dem/serve.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "tests/fuzz/draws.hpp"
#include "tests/unit/xfem/sample_frame.hpp"
#include "xfem/serve.hpp"

namespace fuzz {
namespace {

/// One frame that solves quickly, and the same cut short.
struct Folder {
  std::filesystem::path frame = scratch() / "served.h5", cut = scratch() / "cut.h5", answer = scratch() / "answer.h5";

  Folder() {
    common::Frame sample = sample::walls();
    sample::add_pressed(sample, sample::regular(6, 0.25), {0, 0}, 0.3, {5e6, 0.2});
    common::write_frame(frame, sample, {});
    std::filesystem::copy_file(frame, cut);
    std::filesystem::resize_file(cut, std::filesystem::file_size(frame) / 2);
  }
};

/// Words that a driver may say, and some that none does. Nothing is written outside of `scratch`.
std::string lines(Draws& draws, const Folder& folder) {
  const std::string words[] = {"solve",
                               "done",
                               "-",
                               folder.frame.string(),
                               folder.cut.string(),
                               folder.answer.string(),
                               (scratch() / "none" / "x.h5").string(),
                               (scratch() / "new.h5").string(),
                               "\n",
                               " "};
  std::string text;
  for (int count = draws.integer(0, 40); count > 0; --count) {
    const int kind = draws.integer(0, 12);
    if (kind < 10) {
      text += words[kind];
      if (draws.one_in(8)) continue;
      text += ' ';
    } else if (kind == 10) {
      text += "solve " + folder.frame.string() + " - " + folder.answer.string() + "\n";
    } else {
      // The first of these letters keeps a word of any bytes from being a path.
      text += ":";
      for (int letters = draws.integer(0, 5); letters > 0; --letters) text += static_cast<char>(draws.byte() | 0x10);
    }
  }
  std::replace(text.begin(), text.end(), '\x7f', '/');
  return text;
}

void dem_side(const std::string& text) {
  const int input = ::memfd_create("lines", MFD_CLOEXEC);
  const int output = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  require(input >= 0 && output >= 0 && ::write(input, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
              ::lseek(input, 0, SEEK_SET) == 0,
          "no file in memory");
  const auto exchange = dem::exchange_over(input, output, [] { return false; });
  unless_refused([&] {
    while (exchange(1, {})) {
    }
  });
  ::close(input);
  ::close(output);
}

}  // namespace

void serve(Input input) {
  static const Folder folder;
  static const common::Scene scene = [] {
    common::Scene small = sample::scene();
    small.breakage.nodes = 30;
    return small;
  }();
  Draws draws(input);
  const std::string text = lines(draws, folder);
  dem_side(text);
  std::string resume = text;
  for (std::size_t at = 0; (at = resume.find("solve ", at)) != std::string::npos;) resume.replace(at, 6, "resume ");
  dem_side(resume);

  xfem::SplitService service(scene, 1, [](const std::string&) {});
  std::istringstream in(text);
  std::ostringstream out;
  xfem::serve(service, in, out);
  // One answer for each line up to `done`, and nothing else.
  std::istringstream asked(text), answered(out.str());
  std::string line, answer;
  while (std::getline(asked, line)) {
    require(static_cast<bool>(std::getline(answered, answer)), "a line without an answer");
    require(answer == "done" || answer.starts_with("split ") || answer.starts_with("error "), "an answer of no kind");
    if (answer == "done") break;
  }
  require(!std::getline(answered, answer), "an answer without a line");
}

}  // namespace fuzz
