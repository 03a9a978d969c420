#include "common/io/contents.hpp"

#include <xxhash.h>

#include <memory>

#include "common/io/immutable_file.hpp"

namespace common {
namespace {

bool is_payload(const std::string& path, const Item& item) {
  return item.type != "other" && path != "@payload_hash" && !path.starts_with("provenance/") &&
         !path.starts_with("provenance@");
}

void append_text(std::string& bytes, const std::string& text) {
  const std::uint64_t length = text.size();
  bytes.append(reinterpret_cast<const char*>(&length), sizeof(length));
  bytes += text;
}

}  // namespace

std::string payload_hash(const Contents& contents) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  const auto add = [&](const void* data, std::size_t size) { XXH3_128bits_update(state.get(), data, size); };
  for (const auto& [path, item] : contents) {
    if (!is_payload(path, item)) continue;
    add(path.c_str(), path.size() + 1);
    add(item.type.c_str(), item.type.size() + 1);
    const std::uint64_t rank = item.shape.size();
    add(&rank, sizeof(rank));
    add(item.shape.data(), rank * sizeof(std::uint64_t));
    add(item.bytes.data(), item.bytes.size());
  }
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state.get()));
  return hex(std::as_bytes(std::span(canonical.digest)));
}

Item text_item(const std::string& text) {
  Item item{"string", {}, {}};
  append_text(item.bytes, text);
  return item;
}

Item text_array_item(std::span<const std::string> texts) {
  Item item{"string", {texts.size()}, {}};
  for (const std::string& text : texts) append_text(item.bytes, text);
  return item;
}

std::vector<std::string> texts_of(const Item& item) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at + sizeof(std::uint64_t) <= item.bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, item.bytes.data() + at, sizeof(length));
    texts.push_back(item.bytes.substr(at + sizeof(length), length));
    at += sizeof(length) + length;
  }
  return texts;
}

}  // namespace common
