// Contents to and from HDF5 files. The only place that knows the HDF5 library (1.10 C API).
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "common/io/contents.hpp"
#include "common/io/immutable_file.hpp"

namespace common {

/// The bytes of an HDF5 file with these contents, sealed (see immutable_file.hpp). Each array stands in one chunk with
/// a Fletcher-32 checksum; strings are UTF-8, of variable length in attributes; no times are stored: equal contents
/// give equal bytes. Throws io_failure if the library fails.
std::vector<std::byte> hdf5_image(const Contents& contents);

/// Everything in the HDF5 file `path`, its payload hash also where the file has none. A seal and a payload_hash, where
/// the file has them, are verified. Throws io_failure if the file cannot be read, bad_input naming file and dataset if
/// it is damaged.
///
/// With `wanted`, the contents of a sealed file are only those datasets of it that are there, without their attributes,
/// and the attributes of the root: a dataset costs the library about 0.1 ms, and a frame has ninety. The seal covers
/// the rest, and the payload hash, which is then not computed again.
Contents read_hdf5(const std::filesystem::path& path, const std::set<std::string>* wanted = nullptr);

/// Sets the payload hash in `contents`, adds the provenance and writes the file. Throws io_failure.
WrittenFile write_hdf5(const std::filesystem::path& path, Contents contents, Durability durability);

}  // namespace common
