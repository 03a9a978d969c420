// Who may work in a run directory. Oracle: flock's own rule, that two open files exclude each other and heirs share
// one.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <optional>

#include "common/error.hpp"
#include "dem/directory_lock.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace fs = std::filesystem;

TEST_CASE("a run directory has one holder, and a driver's dem counts as the driver") {
  const scratch::Folder folder;
  const fs::path& directory = folder.path();
  unsetenv("ROCKBREAK_LOCK");
  const auto refused = [&] {
    try {
      const dem::DirectoryLock lock(directory);
    } catch (const common::Error& error) {
      CHECK(error.code() == common::ExitCode::bad_input);
      CHECK_THAT(error.what(), Catch::Contains("at work in this directory"));
      return true;
    }
    return false;
  };
  {
    const dem::DirectoryLock first(directory);
    CHECK(refused());
  }
  CHECK_FALSE(refused());  // the file that stays behind is no lock

  const int driver = open((directory / ".lock").c_str(), O_RDWR);
  REQUIRE(flock(driver, LOCK_EX | LOCK_NB) == 0);
  CHECK(refused());
  setenv("ROCKBREAK_LOCK", std::to_string(driver).c_str(), 1);
  CHECK_FALSE(refused());
  CHECK_FALSE(refused());  // the driver holds it still
  const int other = open(directory.c_str(), O_RDONLY);
  for (const std::string& stale : {std::to_string(other), std::string("977"), std::string("-1"), std::string("x")}) {
    INFO(stale);
    setenv("ROCKBREAK_LOCK", stale.c_str(), 1);
    CHECK(refused());
  }
  close(other);
  close(driver);
  CHECK_FALSE(refused());
  unsetenv("ROCKBREAK_LOCK");
  fs::remove_all(directory);
  CHECK_THROWS_WITH(dem::DirectoryLock(directory), Catch::Contains("cannot be opened"));
}
