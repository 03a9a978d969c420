#include "common/io/hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <utility>

#include "common/error.hpp"
#include "common/io/provenance.hpp"

namespace common {
namespace {

constexpr char kPayloadHash[] = "@payload_hash";

/// The library is not thread-safe as Debian builds it.
std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// A clean error stack for one operation on a file; what the library finds becomes an exception, never output.
class Library {
 public:
  Library() : lock_(library_mutex()) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5Eclear2(H5E_DEFAULT);
  }

 private:
  std::lock_guard<std::mutex> lock_;
};

/// What the library says about its innermost failure.
std::string library_message() {
  std::string message = "HDF5 gives no reason";
  const auto take_first = [](unsigned n, const H5E_error2_t* error, void* target) -> herr_t {
    if (n == 0 && error->desc) *static_cast<std::string*>(target) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &message);
  H5Eclear2(H5E_DEFAULT);
  return message;
}

/// Thrown inside this file only; the public functions add the file's name and the error's kind.
struct LibraryFailure {
  std::string message;
};

template <class T>
T check(T result, const std::string& where) {
  if (result < 0) throw LibraryFailure{where + ": " + library_message()};
  return result;
}

/// An identifier that closes itself.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& where) : id_(check(id, where)), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

Handle properties(hid_t kind) {
  return {H5Pcreate(kind), H5Pclose, "property list"};
}

/// A file in memory that grows by `increment` bytes.
Handle memory_access(std::size_t increment) {
  Handle access = properties(H5P_FILE_ACCESS);
  check(H5Pset_fapl_core(access, increment, false), "memory file");
  return access;
}

Handle text_type(std::size_t size = H5T_VARIABLE) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type");
  check(H5Tset_size(type, size), "string type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
  return type;
}

/// The native type of that name; negative for "string" and "other".
hid_t native_type(const std::string& name) {
  if (name == "int8") return H5T_NATIVE_INT8;
  if (name == "int16") return H5T_NATIVE_INT16;
  if (name == "int32") return H5T_NATIVE_INT32;
  if (name == "int64") return H5T_NATIVE_INT64;
  if (name == "uint8") return H5T_NATIVE_UINT8;
  if (name == "uint16") return H5T_NATIVE_UINT16;
  if (name == "uint32") return H5T_NATIVE_UINT32;
  if (name == "uint64") return H5T_NATIVE_UINT64;
  if (name == "float32") return H5T_NATIVE_FLOAT;
  if (name == "float64") return H5T_NATIVE_DOUBLE;
  return -1;
}

std::string name_of_type(hid_t type) {
  const std::size_t size = H5Tget_size(type);
  std::string name = "other";
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      name = fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", 8 * size);
      break;
    case H5T_FLOAT:
      name = fmt::format("float{}", 8 * size);
      break;
    case H5T_STRING:
      return "string";
    case H5T_ENUM:  // h5py's bool
      return name_of_type(Handle(H5Tget_super(type), H5Tclose, "enumeration"));
    default:
      break;
  }
  return native_type(name) >= 0 ? name : "other";
}

Handle space_of(const Item& item, const std::string& path) {
  const std::vector<hsize_t> shape(item.shape.begin(), item.shape.end());
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, path};
  // A chunk may exceed the extent only where the extent may grow; zero-length arrays need that.
  std::vector<hsize_t> largest = shape;
  for (hsize_t& n : largest) n = n == 0 ? H5S_UNLIMITED : n;
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), largest.data()), H5Sclose, path};
}

/// An item's type and values as the library wants them. A single string is of variable length (what h5py turns into
/// str); the strings of an array are padded to one length, as checksums need that.
struct Stored {
  Handle text;  ///< open while `type` is in use
  hid_t type = -1;
  const void* data = nullptr;
  std::string buffer;
  const char* pointer = nullptr;

  explicit Stored(const Item& item) : type(native_type(item.type)), data(item.bytes.data()) {
    if (item.type != "string") return;
    const std::vector<std::string> texts = texts_of(item);
    if (item.shape.empty()) {
      text = text_type();
      type = text;
      buffer = texts.at(0);
      pointer = buffer.c_str();
      data = &pointer;
      return;
    }
    std::size_t width = 1;
    for (const std::string& one : texts) width = std::max(width, one.size());
    for (const std::string& one : texts) buffer += one + std::string(width - one.size(), '\0');
    text = text_type(width);
    check(H5Tset_strpad(text, H5T_STR_NULLPAD), "string type");
    type = text;
    data = buffer.data();
  }
  Stored(const Stored&) = delete;
};

/// How datasets are made; one for a whole file, as the library takes longer over a property list than over a value.
struct DatasetProperties {
  Handle link = properties(H5P_LINK_CREATE);
  Handle scalar = properties(H5P_DATASET_CREATE);  // the library has no checksums for scalars
  Handle array = properties(H5P_DATASET_CREATE);   // in one chunk, whose size each dataset sets

  DatasetProperties() {
    check(H5Pset_create_intermediate_group(link, 1), "property list");
    check(H5Pset_obj_track_times(scalar, false), "property list");
    check(H5Pset_obj_track_times(array, false), "property list");
    check(H5Pset_fletcher32(array), "property list");
  }
};

Handle create_dataset(hid_t file, const std::string& path, const Item& item, const DatasetProperties& made) {
  const hid_t creation = item.shape.empty() ? made.scalar : made.array;
  if (!item.shape.empty()) {
    std::vector<hsize_t> chunk(item.shape.begin(), item.shape.end());
    for (hsize_t& n : chunk) n = n == 0 ? 1 : n;
    check(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()), path);
  }
  const Stored stored(item);
  Handle set(H5Dcreate2(file, path.c_str(), stored.type, space_of(item, path), made.link, creation, H5P_DEFAULT),
             H5Dclose, path);
  if (!item.bytes.empty()) {
    check(H5Dwrite(set, stored.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, stored.data), path);
  }
  return set;
}

void create_attribute(hid_t object, const std::string& path, const std::string& name, const Item& item) {
  const Stored stored(item);
  Handle attribute(H5Acreate2(object, name.c_str(), stored.type, space_of(item, path), H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose, path);
  if (!item.bytes.empty()) check(H5Awrite(attribute, stored.type, stored.data), path);
}

/// The object of that path; groups are made where there is nothing.
Handle object_at(hid_t file, const std::string& path) {
  Handle object(H5Oopen(file, "/", H5P_DEFAULT), H5Oclose, path);
  for (std::size_t from = 0; from < path.size();) {
    const std::size_t to = std::min(path.find('/', from), path.size());
    const std::string name = path.substr(from, to - from);
    object = check(H5Lexists(object, name.c_str(), H5P_DEFAULT), path) > 0
                 ? Handle(H5Oopen(object, name.c_str(), H5P_DEFAULT), H5Oclose, path)
                 : Handle(H5Gcreate2(object, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
    from = to + 1;
  }
  return object;
}

std::vector<std::byte> unsealed_image(const Contents& contents) {
  Handle creation = properties(H5P_FILE_CREATE);
  check(H5Pset_obj_track_times(creation, false), "file");
  check(H5Pset_istore_k(creation, 1), "file");  // one chunk per dataset: the default index would be half of the file
  Handle file(H5Fcreate("image", H5F_ACC_TRUNC, creation, memory_access(std::size_t{1} << 18)), H5Fclose, "file");

  const DatasetProperties made;
  Handle object;
  std::string open_path = "/";
  for (const auto& [path, item] : contents) {
    const std::size_t at = path.find('@');
    const std::string owner = path.substr(0, at);
    if (at == std::string::npos) {
      object = create_dataset(file, path, item, made);
    } else {
      if (owner != open_path) object = object_at(file, owner);
      create_attribute(object, path, path.substr(at + 1), item);
    }
    open_path = owner;
  }
  object = Handle();
  check(H5Fflush(file, H5F_SCOPE_LOCAL), "file");
  std::vector<std::byte> image(static_cast<std::size_t>(check(H5Fget_file_image(file, nullptr, 0), "file")));
  check(H5Fget_file_image(file, image.data(), image.size()), "file");
  return image;
}

/// Reads the values of a dataset or attribute; read(type, target) fills memory, `limit` bounds what a damaged
/// description may ask for.
template <class Read>
Item read_item(hid_t type, hid_t space, const std::string& path, std::uint64_t limit, const Read& read) {
  Item item{name_of_type(type), {}, {}};
  const H5S_class_t kind = H5Sget_simple_extent_type(space);
  const int rank = check(H5Sget_simple_extent_ndims(space), path);
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), path);
  item.shape.assign(shape.begin(), shape.end());
  if (kind != H5S_SIMPLE && kind != H5S_SCALAR) item.type = "other";
  if (item.type == "other") return item;

  const bool variable = item.type == "string" && check(H5Tis_variable_str(type), path) > 0;
  const std::uint64_t width = variable ? sizeof(char*) : H5Tget_size(type);
  std::uint64_t bytes = width;
  for (const hsize_t n : shape) {
    if (n != 0 && bytes > limit / n) throw LibraryFailure{path + ": claims more values than the file can hold"};
    bytes *= n;
  }
  if (bytes == 0) return item;
  if (item.type != "string") {
    item.bytes.resize(bytes);
    read(native_type(item.type), item.bytes.data());
    return item;
  }
  std::vector<std::string> texts(bytes / width);
  if (variable) {
    std::vector<char*> pointers(texts.size(), nullptr);
    const Handle memory = text_type();
    check(H5Tset_cset(memory, H5Tget_cset(type)), path);
    read(memory, pointers.data());
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i] = pointers[i] ? pointers[i] : "";
    check(H5Dvlen_reclaim(memory, space, H5P_DEFAULT, pointers.data()), path);
  } else {
    std::string buffer(bytes, '\0');
    read(type, buffer.data());
    const std::string padding = H5Tget_strpad(type) == H5T_STR_SPACEPAD ? std::string(" \0", 2) : std::string(1, '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) {
      texts[i] = buffer.substr(i * width, width);
      if (H5Tget_strpad(type) == H5T_STR_NULLTERM) texts[i] = texts[i].c_str();
      texts[i].erase(texts[i].find_last_not_of(padding) + 1);
    }
  }
  item.bytes = text_array_item(texts).bytes;
  return item;
}

void read_attributes(hid_t object, const std::string& owner, std::uint64_t limit, Contents& contents) {
  H5O_info_t info;
  check(H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS), owner);
  for (hsize_t i = 0; i < info.num_attrs; ++i) {
    const Handle attribute(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, owner);
    std::string name(static_cast<std::size_t>(check(H5Aget_name(attribute, 0, nullptr), owner)), '\0');
    check(H5Aget_name(attribute, name.size() + 1, name.data()), owner);
    const std::string path = owner + "@" + name;
    const Handle type(H5Aget_type(attribute), H5Tclose, path);
    const Handle space(H5Aget_space(attribute), H5Sclose, path);
    contents[path] = read_item(type, space, path, limit,
                               [&](hid_t memory, void* target) { check(H5Aread(attribute, memory, target), path); });
  }
}

/// Paths of all objects; that of the root is empty.
std::vector<std::string> objects_in(hid_t file) {
  std::vector<std::string> paths;
  const auto collect = [](hid_t, const char* name, const H5O_info_t*, void* target) -> herr_t {
    try {
      static_cast<std::vector<std::string>*>(target)->push_back(std::string(name) == "." ? "" : name);
    } catch (...) {  // no exception may pass through the library
      return -1;
    }
    return 0;
  };
  check(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, collect, &paths, H5O_INFO_BASIC), "objects");
  return paths;
}

bool stands_in(hid_t file, const std::string& path) {
  for (std::size_t to = path.find('/');; to = path.find('/', to + 1)) {
    if (check(H5Lexists(file, path.substr(0, to).c_str(), H5P_DEFAULT), path) == 0) return false;
    if (to == std::string::npos) return true;
  }
}

/// The root and, of `wanted`, what is there.
std::vector<std::string> wanted_in(hid_t file, const std::set<std::string>& wanted) {
  std::vector<std::string> paths{""};
  for (const std::string& path : wanted) {
    if (stands_in(file, path)) paths.push_back(path);
  }
  return paths;
}

/// The size of the file that its own superblock states; 0 if that cannot be told (a user block, other address sizes).
std::uint64_t described_size(std::span<const std::byte> image) {
  constexpr char kSignature[] = "\x89HDF\r\n\x1a\n";
  constexpr std::size_t kLongestSuperblock = 96;
  if (image.size() < kLongestSuperblock || std::memcmp(image.data(), kSignature, 8) != 0) return 0;
  const auto version = std::to_integer<unsigned>(image[8]);
  if (version > 3 || std::to_integer<unsigned>(image[version < 2 ? 13 : 9]) != sizeof(std::uint64_t)) return 0;
  constexpr std::array<std::size_t, 4> kPlace = {40, 44, 28, 28};
  std::uint64_t end = 0;
  std::memcpy(&end, image.data() + kPlace[version], sizeof(end));
  return end;
}

/// The length of an unsealed file, as far as its superblock tells it.
void check_length(std::span<const std::byte> file) {
  const std::uint64_t end = described_size(file);
  if (end > file.size()) {
    throw LibraryFailure{fmt::format("truncated: has {} bytes, expected {}", file.size(), end)};
  }
  if (end > 0 && file.size() > end && file.size() - end <= kSealBytes) {
    throw LibraryFailure{"damaged: the seal at its end is incomplete"};
  }
}

/// Everything, or of `wanted` the datasets that are there, without their attributes, and the attributes of the root.
Contents contents_of_image(std::span<std::byte> image, const std::set<std::string>* wanted = nullptr) {
  const Handle access = memory_access(4096);
  check(H5Pset_file_image(access, image.data(), image.size()), "file");
  const Handle file(H5Fopen("image", H5F_ACC_RDONLY, access), H5Fclose, "not a complete HDF5 file");
  // Compression gives at most a factor of about 1000.
  const std::uint64_t limit = 1000 * image.size() + (std::uint64_t{1} << 20);
  Contents contents;
  for (const std::string& path : wanted ? wanted_in(file, *wanted) : objects_in(file)) {
    const std::string where = "dataset " + path;
    const Handle object(H5Oopen(file, path.empty() ? "/" : path.c_str(), H5P_DEFAULT), H5Oclose, where);
    if (H5Iget_type(object) == H5I_DATASET) {
      const Handle type(H5Dget_type(object), H5Tclose, where);
      const Handle space(H5Dget_space(object), H5Sclose, where);
      contents[path] = read_item(type, space, where, limit, [&](hid_t memory, void* target) {
        check(H5Dread(object, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, target), where);
      });
    }
    if (!wanted || path.empty()) read_attributes(object, path, limit, contents);
  }
  return contents;
}

/// What is wrong with an unsealed file, empty if the library gets through it. Tried in a child process: damaged
/// metadata can lead HDF5 1.10 out of bounds or to gigabytes. Sealed files need no trial, so ours cost nothing.
std::string failure_in_trial(std::span<std::byte> image) {
  constexpr unsigned kSecondsAtMost = 60;
  constexpr std::size_t kLongestMessage = 2000;  // fits the pipe, so that the child never waits
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) < 0) return {};  // without a pipe or a process: go on without the trial
  const pid_t child = ::fork();
  if (child == 0) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) std::signal(signal, SIG_DFL);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::alarm(kSecondsAtMost);
    std::string message;
    try {
      contents_of_image(image);
    } catch (const LibraryFailure& failure) {
      message = failure.message.substr(0, kLongestMessage);
    } catch (...) {
      message = "damaged: describes arrays that do not fit into memory";
    }
    const bool told = ::write(ends[1], message.data(), message.size()) == static_cast<ssize_t>(message.size());
    ::_exit(told ? 0 : 1);
  }
  ::close(ends[1]);
  std::string message(kLongestMessage, '\0');
  ssize_t length = 0;
  int status = 0;
  if (child > 0) {
    do {
      length = ::read(ends[0], message.data(), message.size());
    } while (length < 0 && errno == EINTR);
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(ends[0]);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "damaged: HDF5 breaks down over it";
  message.resize(static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  return message;
}

}  // namespace

std::vector<std::byte> hdf5_image(const Contents& contents) {
  try {
    std::vector<std::byte> image;
    {
      const Library library;
      image = unsealed_image(contents);
    }
    append_seal(image);
    return image;
  } catch (const LibraryFailure& failure) {
    throw io_failure("HDF5 image: " + failure.message);
  }
}

Contents read_hdf5(const std::filesystem::path& path, const std::set<std::string>* wanted) {
  std::vector<std::byte> file = read_whole_file(path);
  const Seal seal = check_seal(file);
  if (seal == Seal::broken) {
    throw bad_input(path.string() + ": damaged: its bytes do not match the checksum at its end");
  }
  if (seal == Seal::intact) file.resize(file.size() - kSealBytes);
  if (file.empty()) throw bad_input(path.string() + ": empty, expected an HDF5 file");
  Contents contents;
  try {
    const Library library;
    if (seal != Seal::intact) {
      check_length(file);
      if (const std::string failure = failure_in_trial(file); !failure.empty()) throw LibraryFailure{failure};
    } else if (wanted) {  // the seal vouches for what is not looked at, and for the payload hash
      contents = contents_of_image(file, wanted);
      const auto stored = contents.find(kPayloadHash);
      if (stored != contents.end() && stored->second.type == "string") return contents;
    }
    contents = contents_of_image(file);
  } catch (const LibraryFailure& failure) {
    throw bad_input(path.string() + ": " + failure.message);
  } catch (const std::bad_alloc&) {
    throw bad_input(path.string() + ": damaged: describes arrays that do not fit into memory");
  }
  const std::string found = payload_hash(contents);
  if (const auto stored = contents.find(kPayloadHash); stored != contents.end()) {
    const std::vector<std::string> expected =
        stored->second.type == "string" ? texts_of(stored->second) : std::vector<std::string>{};
    if (expected.size() != 1 || expected[0] != found) {
      throw bad_input(fmt::format("{}: damaged or edited: the hash of its payload is {}, its payload_hash {}",
                                  path.string(), found, expected.empty() ? "not a string" : expected[0]));
    }
  }
  contents[kPayloadHash] = text_item(found);
  return contents;
}

WrittenFile write_hdf5(const std::filesystem::path& path, Contents contents, Durability durability) {
  WrittenFile written{path, 0, payload_hash(contents), {}};
  contents[kPayloadHash] = text_item(written.payload_hash);
  for (const auto& [name, value] : provenance()) contents["provenance@" + name] = text_item(value);
  const std::vector<std::byte> image = hdf5_image(contents);
  write_atomically(path, image, durability);
  written.bytes = image.size();
  written.file_hash = hash_hex(image);
  return written;
}

}  // namespace common
