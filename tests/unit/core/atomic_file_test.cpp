#include "astroid/core/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "astroid/core/error.hpp"
#include "astroid/test/file_size_limit.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "product.txt";
  AtomicFile file(path);
  file.write(std::string(200000, 'x'));  // more than the buffer
  EXPECT_FALSE(std::filesystem::exists(path));
  file.commit();
  EXPECT_EQ(std::filesystem::file_size(path), 200000U);
  EXPECT_FALSE(std::filesystem::exists(partial_path(path)));
}

TEST(AtomicFile, KeepsTheOrderOfSmallAndLargeParts) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "product.txt";
  std::string expected;
  AtomicFile file(path);
  for (const std::size_t size : {1U, 65535U, 3U, 65536U, 70000U, 2U, 60000U, 60000U}) {
    const std::string part(size, static_cast<char>('a' + expected.size() % 26));
    file.write(part);
    expected += part;
  }
  file.overwrite(65530, "0123456789");
  expected.replace(65530, 10, "0123456789");
  file.write("end");
  EXPECT_THROW(file.overwrite(expected.size(), "late!"), BugError) << "only what is written can be replaced";
  file.commit(Durability::kWithFolder);
  EXPECT_EQ(read_text_file(path), expected + "end");
  EXPECT_FALSE(std::filesystem::exists(partial_path(path)));
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("product.txt", "old");
  {
    AtomicFile file(path);
    file.write("new");
  }
  EXPECT_EQ(read_text_file(path), "old");
  EXPECT_FALSE(std::filesystem::exists(partial_path(path)));
}

TEST(AtomicFile, ReportsAFullDiskAndKeepsTheOldFile) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("product.txt", "old");
  {
    const test::FileSizeLimit limit(1000);
    EXPECT_THAT([&] { write_text_file(path, std::string(5000, 'x')); },
                ThrowsMessage<EnvironmentError>(HasSubstr("product.txt: File too large")));
  }
  EXPECT_EQ(read_text_file(path), "old");
  EXPECT_FALSE(std::filesystem::exists(partial_path(path)));
}

TEST(AtomicFile, NamesPathAndCauseWhenTheFolderIsMissing) {
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { write_text_file(folder.path() / "no" / "product.txt", "x"); },
              ThrowsMessage<EnvironmentError>(HasSubstr("no/product.txt: No such file or directory")));
  EXPECT_THAT([&] { write_text_file(folder.path(), "x"); }, ThrowsMessage<EnvironmentError>(HasSubstr("directory")));
}

TEST(ReadTextFile, NamesTheLineOfANulByte) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("binary.csv", std::string("a,b\n1,\0002\n", 9));
  EXPECT_THAT([&] { (void)read_text_file(path); },
              ThrowsMessage<InputError>(HasSubstr("binary.csv:2: contains a NUL")));
}

TEST(ReadTextFile, NamesPathAndCause) {
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { (void)read_text_file(folder.path() / "absent"); },
              ThrowsMessage<EnvironmentError>(HasSubstr("absent: No such file or directory")));
  EXPECT_THAT([&] { (void)read_text_file(folder.path()); },
              ThrowsMessage<EnvironmentError>(HasSubstr("Is a directory")));
}

TEST(PartialPath, IgnoresATrailingSlash) {
  EXPECT_EQ(partial_path("results/"), "results.partial");
}

}  // namespace
}  // namespace astroid
