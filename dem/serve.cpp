#include "dem/serve.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "common/error.hpp"

namespace dem {
namespace {

// One line without its newline; nothing at the end of the input or when interrupted.
std::optional<std::string> read_line(int descriptor, const std::function<bool()>& interrupted) {
  std::string line;
  char c = 0;
  for (;;) {
    const ssize_t n = read(descriptor, &c, 1);
    if (n == 1) {
      if (c == '\n') return line;
      line += c;
    } else if (n == 0 || errno != EINTR || interrupted()) {
      return std::nullopt;
    }
  }
}

}  // namespace

void say(int descriptor, std::string line) {
  std::replace(line.begin(), line.end(), '\n', ' ');
  line += '\n';
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t n = write(descriptor, line.data() + written, line.size() - written);
    if (n < 0 && errno != EINTR) return;
    if (n > 0) written += static_cast<std::size_t>(n);
  }
}

std::function<std::optional<std::string>(std::int64_t, const common::WrittenFile&)> exchange_over(
    int input, int output, std::function<bool()> interrupted) {
  return [=](std::int64_t frame, const common::WrittenFile& file) -> std::optional<std::string> {
    say(output, fmt::format("frame {} {} {} {}", frame, file.path.string(), file.bytes, file.payload_hash));
    const std::optional<std::string> line = read_line(input, interrupted);
    if (!line || *line == "stop" || *line == "done") return std::nullopt;
    if (line->rfind("resume ", 0) != 0 || line->size() == 7) {
      throw common::bad_input(
          fmt::format("standard input: found \"{}\", expected \"resume SPLITPATH\", \"resume -\" or \"stop\"", *line));
    }
    const std::string split = line->substr(7);
    return split == "-" ? std::string() : split;
  };
}

}  // namespace dem
