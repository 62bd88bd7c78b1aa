#include <dirent.h>
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cerrno>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace {

int calls_left = -1;  // negative: none fails

}  // namespace

// These replace the C library's functions in this program.
extern "C" {
dirent* readdir(DIR* folder) {
  static const auto real = reinterpret_cast<dirent* (*)(DIR*)>(dlsym(RTLD_NEXT, "readdir"));
  if (calls_left < 0) return real(folder);
  if (calls_left-- > 0) return real(folder);
  calls_left = 0;
  errno = EIO;
  return nullptr;
}
}

namespace adit::host {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NamesIn, ListsADirectoryInOrder) {
  const Folder folder;
  for (const char* name : {"b", "a", "c"}) folder.put(name, "");
  EXPECT_THAT(names_in(folder.path()).value(), ElementsAre("a", "b", "c"));
}

TEST(NamesIn, IsEmptyWithoutADirectory) {
  const Folder folder;
  EXPECT_THAT(names_in(folder / "none").value(), IsEmpty());
  EXPECT_EQ(names_in(folder.put("file", "")).error(), "Not a directory");
}

TEST(NamesIn, IsBounded) {
  const Folder folder;
  for (const char* name : {"a", "b"}) folder.put(name, "");
  EXPECT_EQ(names_in(folder.path(), 2).value().size(), 2u);
  folder.put("c", "");
  EXPECT_EQ(names_in(folder.path(), 2).error(), "holds more than 2 files");
}

/// A stick is unplugged while it is read.
TEST(NamesIn, FailsIfADirectoryCannotBeReadToItsEnd) {
  const Folder folder;
  for (const char* name : {"a", "b", "c"}) folder.put(name, "");
  for (int calls = 0; calls < 5; ++calls) {
    calls_left = calls;
    const auto names = names_in(folder.path());
    calls_left = -1;
    ASSERT_FALSE(names) << calls;
    EXPECT_EQ(names.error(), "Input/output error");
  }
}

}  // namespace
}  // namespace adit::host
