// Damaged files: every one is refused with a clean error or read as what was written; and what h5py makes of ours.
#include <fmt/format.h>

#include <cstdlib>
#include <random>

#include "common/io/hdf5_file.hpp"
#include "samples.hpp"

using namespace common_test;

namespace {

std::vector<std::byte> frame_bytes(const Directory& directory, Contents& contents) {
  Frame frame = sample_frame();
  write_frame(directory / "sound.h5", frame, {});
  contents = read_hdf5(directory / "sound.h5");
  return read_whole_file(directory / "sound.h5");
}

bool without_provenance_equal(Contents a, Contents b) {
  for (Contents* c : {&a, &b})
    std::erase_if(*c, [](const auto& entry) { return entry.first.starts_with("provenance"); });
  return a == b;
}

/// 'r' refused, 's' read as the same payload, 'x' anything else.
char outcome(const std::filesystem::path& path, const std::vector<std::byte>& bytes, const Contents& sound) {
  write_atomically(path, bytes, {});
  try {
    return without_provenance_equal(read_hdf5(path), sound) ? 's' : 'x';
  } catch (const Error& error) {
    const bool names_file = std::string(error.what()).starts_with(path.string() + ": ");
    return error.code() == ExitCode::bad_input && names_file ? 'r' : 'x';
  }
}

}  // namespace

TEST_CASE("Every truncated frame file is refused") {
  const Directory directory;
  Contents sound;
  const std::vector<std::byte> file = frame_bytes(directory, sound);
  for (std::size_t length = 0; length < file.size(); length += length < 200 || length + 200 > file.size() ? 1 : 97) {
    const std::vector<std::byte> part(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length));
    // Cut off exactly behind the image it is a complete unsealed file, with its payload hash.
    const char expected = length == file.size() - kSealBytes ? 's' : 'r';
    CHECK(outcome(directory / "cut.h5", part, sound) == expected);
  }
  write_atomically(directory / "half.h5", std::span(file).first(file.size() / 2), {});
  CHECK(error_of([&] { read_frame(directory / "half.h5"); }).text ==
        fmt::format("{}: truncated: has {} bytes, expected {}", (directory / "half.h5").string(), file.size() / 2,
                    file.size() - kSealBytes));
}

TEST_CASE("A frame file with any bit flipped is refused") {
  const Directory directory;
  Contents sound;
  std::vector<std::byte> file = frame_bytes(directory, sound);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const std::size_t bit = random() % (8 * file.size());
    file[bit / 8] ^= std::byte{1} << bit % 8;
    CHECK(outcome(directory / "flipped.h5", file, sound) == 'r');
    file[bit / 8] ^= std::byte{1} << bit % 8;
  }
}

TEST_CASE("Without its seal, a frame file with a bit flipped is refused or reads as what was written") {
  const Directory directory;
  Contents sound;
  std::vector<std::byte> file = frame_bytes(directory, sound);
  file.resize(file.size() - kSealBytes);
  std::mt19937_64 random(2);
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t bit = random() % (8 * file.size());
    file[bit / 8] ^= std::byte{1} << bit % 8;
    const char result = outcome(directory / "flipped.h5", file, sound);
    CHECK(result != 'x');
    refused += result == 'r';
    file[bit / 8] ^= std::byte{1} << bit % 8;
  }
  CHECK(refused > 0);
}

TEST_CASE("A damaged array is named even where no hash covers it") {
  const Directory directory;
  const std::vector<double> values(1000, 0.123456789);
  Contents contents;
  contents["group/values"] = array_item(std::span<const double>(values));
  std::vector<std::byte> image = hdf5_image(contents);
  image.resize(image.size() - kSealBytes);
  const auto pattern = std::as_bytes(std::span(values).first(2));
  const auto at = std::search(image.begin(), image.end(), pattern.begin(), pattern.end());
  REQUIRE(at != image.end());
  *at ^= std::byte{1};
  write_atomically(directory / "x.h5", image, {});
  CHECK(error_of([&] { read_hdf5(directory / "x.h5"); }).text ==
        (directory / "x.h5").string() + ": dataset group/values: data error detected by Fletcher32 checksum");
}

TEST_CASE("What is no HDF5 file is refused as such") {
  const Directory directory;
  const std::string text = "particles: 12\n";
  write_atomically(directory / "x.h5", std::as_bytes(std::span(text)), {});
  const Thrown thrown = error_of([&] { read_hdf5(directory / "x.h5"); });
  CHECK_THAT(thrown.text, Catch::StartsWith((directory / "x.h5").string() + ": not a complete HDF5 file: "));
  CHECK(thrown.code == ExitCode::bad_input);
  write_atomically(directory / "x.h5", {}, {});
  CHECK(error_of([&] { read_hdf5(directory / "x.h5"); }).text ==
        (directory / "x.h5").string() + ": empty, expected an HDF5 file");
}

TEST_CASE("Equal contents give equal bytes") {
  const Directory directory;
  Frame frame = sample_frame();
  const WrittenFile first = write_frame(directory / "a.h5", frame, {});
  const WrittenFile second = write_frame(directory / "b.h5", frame, {});
  CHECK(first.file_hash == second.file_hash);
}

TEST_CASE("The payload hash covers every item but itself and the provenance") {
  const Directory directory;
  Contents sound;
  frame_bytes(directory, sound);
  const std::string hash = payload_hash(sound);
  CHECK(texts_of(sound.at("@payload_hash")) == std::vector<std::string>{hash});
  for (const auto& [path, item] : sound) {
    const bool covered = path != "@payload_hash" && !path.starts_with("provenance@");
    Contents without = sound, renamed = sound, reshaped = sound, retyped = sound;
    without.erase(path);
    CHECK((payload_hash(without) != hash) == covered);
    reshaped[path].shape.push_back(1);
    CHECK((payload_hash(reshaped) != hash) == covered);
    retyped[path].type = "uint16";
    CHECK((payload_hash(retyped) != hash) == covered);
    if (item.bytes.empty()) continue;
    Contents changed = sound;
    changed[path].bytes.back() ^= 1;
    CHECK((payload_hash(changed) != hash) == covered);
  }
}

TEST_CASE("Every dataset of frame and split has a unit and a description, stresses their sign") {
  const Directory directory;
  Frame frame = sample_frame();
  Split split = sample_split();
  write_frame(directory / "f.h5", frame, {});
  write_split(directory / "s.h5", split, {});
  for (const char* name : {"f.h5", "s.h5"}) {
    const Contents contents = read_hdf5(directory / name);
    for (const char* attribute : {"git", "compiler", "flags", "host_cpu"}) {
      CHECK(!texts_of(contents.at(std::string("provenance@") + attribute)).at(0).empty());
    }
    for (const auto& [path, item] : contents) {
      if (path.find('@') != std::string::npos) continue;
      CHECK(contents.contains(path + "@unit"));
      CHECK(contents.contains(path + "@description"));
      if (path == "particles/mean_stress") {
        CHECK_THAT(texts_of(contents.at(path + "@description")).at(0), Catch::Contains("compression positive"));
      }
    }
  }
}

namespace {

/// Runs a Python program that imports h5py; true if it ends with exit code 0.
bool python(const std::string& program, const std::string& arguments) {
  return std::system(("/usr/bin/python3 -c '" + program + "' " + arguments).c_str()) == 0;
}

}  // namespace

TEST_CASE("h5py reads the files, and Python computes the same payload hash") {
  if (!python("import h5py", "")) {
    WARN("skipped: /usr/bin/python3 has no h5py");
    return;
  }
  const Directory directory;
  Frame frame = sample_frame();
  Split split = sample_split();
  Frame empty;
  write_frame(directory / "f.h5", frame, {});
  write_split(directory / "s.h5", split, {});
  write_frame(directory / "e.h5", empty, {});
  CHECK(python(
      "import sys, h5py, numpy as np\n"
      "f = h5py.File(sys.argv[1]); s = h5py.File(sys.argv[2])\n"
      "assert f.attrs[\"schema\"] == \"frame/1\" and f.attrs[\"stage\"] == \"shear\" and f.attrs[\"final\"] == 0\n"
      "assert f.attrs[\"seed\"] == 0xfedcba9876543210 and f.attrs[\"time\"] == 0.1 + 0.2\n"
      "assert list(f[\"particles/id\"][:]) == [3, 9, 17, 40] and f[\"particles/boundary\"].dtype == np.uint8\n"
      "assert f[\"particles/vertices\"].shape == (14, 2) and f[\"particles/vertices\"][2, 1] == 0.8\n"
      "assert f[\"particles/mass\"].attrs[\"unit\"] == \"kg\" and f[\"particles/mass\"].fletcher32\n"
      "assert f[\"checkpoint/servo\"].shape == (0,) and f[\"provenance\"].attrs[\"compiler\"]\n"
      "assert s[\"refusals/reason\"].asstr()[0] == \"crack in element 7: \\u03c3 is not finite\"\n"
      "assert s[\"broken/path\"].shape == (1, 2, 2) and s[\"work/solved\"][0] == 3\n"
      "assert s[\"particles/status\"].dtype == np.int32 and np.isnan(s[\"particles/min_safety_factor\"][0])\n",
      (directory / "f.h5").string() + " " + (directory / "s.h5").string()));
  CHECK(std::system(("/usr/bin/python3 " ROCKBREAK_SOURCE_DIR "/pipeline/rockbreak/run/payload_hash.py " +
                     (directory / "f.h5").string() + " " + (directory / "s.h5").string() + " " +
                     (directory / "e.h5").string() + " > /dev/null")
                        .c_str()) == 0);
}

TEST_CASE("A contact state that h5py wrote, compressed and big-endian, is read") {
  if (!python("import h5py", "")) {
    WARN("skipped: /usr/bin/python3 has no h5py");
    return;
  }
  const Directory directory;
  const std::string path = (directory / "f.h5").string();
  for (const char* libver : {"earliest", "latest"}) {
    REQUIRE(
        python("import sys, h5py, numpy as np\n"
               "f = h5py.File(sys.argv[1], \"w\", libver=sys.argv[2])\n"
               "f[\"particles/id\"] = np.arange(2)\n"
               "f[\"particles/position\"] = np.array([[0, 0], [1, 0.5]], \">f8\")\n"
               "f[\"particles/angle\"] = np.zeros(2)\n"
               "f[\"particles/boundary\"] = np.array([True, False])\n"
               "f[\"particles/vertex_offset\"] = np.array([0, 3, 6], \">i4\")\n"
               "f.create_dataset(\"particles/vertices\", data=[[0., 0], [1, 0], [0, 1]] * 2, compression=\"gzip\", "
               "shuffle=True)\n"
               "f[\"contacts/a\"] = [0]; f[\"contacts/b\"] = [1]\n"
               "f[\"contacts/point\"] = [[0.5, 0.5]]; f[\"contacts/force\"] = [[1., 2]]\n"
               "f[\"notes\"] = \"by hand\"; f[\"extra\"] = np.zeros(3, [(\"x\", float), (\"y\", int)]); f[\"none\"] = "
               "h5py.Empty(\"f\")\n"
               "f.close()\n",
               path + " " + libver));
    const Frame frame = read_frame(path, FrameContent::contact_state);
    CHECK(frame.particles.position[1] == Vec2(1, 0.5));
    CHECK(frame.particles.boundary == std::vector<std::uint8_t>{1, 0});
    CHECK(frame.particles.vertex_offset == std::vector<std::int64_t>{0, 3, 6});
    CHECK(frame.particles.vertices[4] == Vec2(1, 0));
    CHECK(frame.contacts.force[0] == Vec2(1, 2));
    CHECK(!frame.payload_hash.empty());
  }
}
