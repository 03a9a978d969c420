// Files of sections named by keys. Oracle: the message that each key gives on its own.
#include "common/config/specification.hpp"

#include <catch2/catch.hpp>

#include "common/config/document.hpp"
#include "scratch.hpp"

TEST_CASE("a failure inside a section's file does not make the next file one that is named by another") {
  const scratch::Folder folder;
  folder.write("first.yaml", "inner: word\n");
  folder.write("second.yaml", "b: 2\n");
  const auto document = folder.write("case.yaml", "one: {file: first.yaml}\ntwo: {file: second.yaml}\n");
  int a = 0, b = 0;
  common::Specification keys;
  keys.section_file("one.file", folder.path(), "keys of one");
  keys.integer("one.inner.a", a, 0, 9, "-", common::UsedBy::both, "a");
  keys.shorthand("one.inner",
                 [](const common::Value& value) -> common::Value { common::refuse(value, "one.inner", "a map"); });
  keys.section_file("two.file", folder.path(), "keys of two");
  keys.integer("two.b", b, 0, 9, "-", common::UsedBy::both, "b");
  const std::string message = scratch::message_of(folder, [&] {
    keys.read(common::load_document(document));
    keys.finish();
  });
  CHECK_THAT(message, Catch::Contains("one.inner: found \"word\", expected a map"));
  CHECK_THAT(message, !Catch::Contains("named by another"));
  CHECK(b == 2);
}
