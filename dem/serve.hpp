// The resident protocol of `dem run --serve` (INTERFACES: Serve), one line each way.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/io/immutable_file.hpp"

namespace dem {

/// Writes one line; a newline inside `line` becomes a space. A reader that has gone is no error.
void say(int descriptor, std::string line);

/// Prints `frame K PATH BYTES HASH` and waits for the answer: `resume SPLITPATH` gives the path, `resume -` an empty
/// one; `stop`, `done`, a closed input or an interruption give nothing. Throws bad_input for another line.
std::function<std::optional<std::string>(std::int64_t, const common::WrittenFile&)> exchange_over(
    int input, int output, std::function<bool()> interrupted);

}  // namespace dem
