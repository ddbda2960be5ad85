#include "astroid/core/product_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

void run(const fs::path& path, ExistingProducts existing, const std::string& text) {
  ProductFolder folder(path, existing);
  write_text_file(folder.file("analysis/targets.csv"), text);
  write_text_file(folder.file("run.json"), "{}");
  folder.commit();
}

TEST(ProductFolder, AppearsUnderItsNameWhenCommitted) {
  const test::TemporaryFolder parent;
  const fs::path path = parent.path() / "new" / "results";
  {
    ProductFolder folder(path / "", ExistingProducts::kRefuse);  // with a trailing slash
    write_text_file(folder.file("images/0001.fits"), "pixels");
    EXPECT_FALSE(fs::exists(path));
    EXPECT_TRUE(fs::exists(parent.path() / "new" / "results.partial" / "images" / "0001.fits"));
    folder.commit();
    EXPECT_THROW(folder.commit(), BugError);
  }
  EXPECT_EQ(read_text_file(path / "images" / "0001.fits"), "pixels");
  EXPECT_FALSE(fs::exists(path / ".lock"));
  EXPECT_FALSE(fs::exists(partial_path(path)));
}

TEST(ProductFolder, LeavesNoFoldersOfARunThatWroteNothing) {
  const test::TemporaryFolder parent;
  fs::create_directory(parent.path() / "old");
  { const ProductFolder folder(parent.path() / "old" / "new" / "newer" / "results", ExistingProducts::kRefuse); }
  EXPECT_FALSE(fs::exists(parent.path() / "old" / "new"));
  EXPECT_TRUE(fs::exists(parent.path() / "old")) << "it was there before";
}

TEST(ProductFolder, RefusesToTouchFinishedProducts) {
  const test::TemporaryFolder parent;
  const fs::path path = parent.path() / "results";
  run(path, ExistingProducts::kRefuse, "old");
  EXPECT_THAT([&] { ProductFolder(path, ExistingProducts::kRefuse); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("results: is there already"), HasSubstr("--overwrite"))));
  EXPECT_THAT([&] { ProductFolder(path, ExistingProducts::kResume); },
              ThrowsMessage<InputError>(HasSubstr("holds a finished run already")));
  EXPECT_EQ(read_text_file(path / "analysis" / "targets.csv"), "old");
  EXPECT_FALSE(fs::exists(partial_path(path)));
}

TEST(ProductFolder, OverwritesOnlyAtTheEnd) {
  const test::TemporaryFolder parent;
  const fs::path path = parent.path() / "results";
  run(path, ExistingProducts::kRefuse, "old");
  {
    ProductFolder folder(path, ExistingProducts::kOverwrite);
    write_text_file(folder.file("run.json"), "{}");
    EXPECT_EQ(read_text_file(path / "analysis" / "targets.csv"), "old");
    folder.commit();
  }
  EXPECT_FALSE(fs::exists(path / "analysis"));
  EXPECT_TRUE(fs::exists(path / "run.json"));
  EXPECT_FALSE(fs::exists(partial_path(path)));
}

TEST(ProductFolder, NeverOverwritesWhatIsNotOurs) {
  const test::TemporaryFolder parent;
  parent.write("thesis/chapter1.tex", "years of work");
  EXPECT_THAT([&] { ProductFolder(parent.path() / "thesis", ExistingProducts::kOverwrite); },
              ThrowsMessage<InputError>(HasSubstr("no run.json")));
  EXPECT_THAT([&] { ProductFolder(parent.path() / "thesis", ExistingProducts::kRefuse); },
              ThrowsMessage<InputError>(HasSubstr("cannot be overwritten")));
  EXPECT_THAT([&] { ProductFolder(parent.path() / "thesis/chapter1.tex", ExistingProducts::kOverwrite); },
              ThrowsMessage<InputError>(HasSubstr("is not a folder")));
  EXPECT_EQ(read_text_file(parent.path() / "thesis/chapter1.tex"), "years of work");
}

TEST(ProductFolder, ResumesAnUnfinishedRun) {
  const test::TemporaryFolder parent;
  const fs::path path = parent.path() / "results";
  {
    const ProductFolder folder(path, ExistingProducts::kRefuse);
    write_text_file(folder.file("images/0001.fits"), "pixels");
    write_text_file(folder.file("images/0002.fits.partial"), "pix");
  }
  EXPECT_FALSE(fs::exists(path));
  EXPECT_THAT(
      [&] { ProductFolder(path, ExistingProducts::kRefuse); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("results.partial: an unfinished run"), HasSubstr("--overwrite"))));
  {
    ProductFolder folder(path, ExistingProducts::kResume);
    EXPECT_TRUE(folder.resumed());
    EXPECT_EQ(read_text_file(folder.file("images/0001.fits")), "pixels");
    folder.commit();
  }
  EXPECT_TRUE(fs::exists(path / "images/0001.fits"));
  EXPECT_FALSE(fs::exists(path / "images/0002.fits.partial"));
}

TEST(ProductFolder, StartsAnewWithOverwriteAndResumesNothing) {
  const test::TemporaryFolder parent;
  const fs::path path = parent.path() / "results";
  {
    const ProductFolder folder(path, ExistingProducts::kResume);
    EXPECT_FALSE(folder.resumed());
    write_text_file(folder.file("old.txt"), "old");
  }
  const ProductFolder folder(path, ExistingProducts::kOverwrite);
  EXPECT_FALSE(fs::exists(folder.file("old.txt")));
}

TEST(ProductFolder, LeavesNothingWhenNothingWasWritten) {
  const test::TemporaryFolder parent;
  { const ProductFolder folder(parent.path() / "results", ExistingProducts::kRefuse); }
  EXPECT_TRUE(fs::is_empty(parent.path()));
}

TEST(ProductFolder, AcceptsAnEmptyFolder) {
  const test::TemporaryFolder parent;
  const fs::path path = parent.path() / "results";
  fs::create_directory(path);
  run(path, ExistingProducts::kRefuse, "new");
  EXPECT_TRUE(fs::exists(path / "run.json"));
}

TEST(ProductFolder, KeepsTwoRunsApart) {
  const test::TemporaryFolder parent;
  const ProductFolder first(parent.path() / "results", ExistingProducts::kRefuse);
  EXPECT_THAT([&] { ProductFolder(parent.path() / "results", ExistingProducts::kOverwrite); },
              ThrowsMessage<InputError>(HasSubstr("another run is writing this folder")));
}

TEST(ProductFolder, ListsItsProductsWithChecksums) {
  const test::TemporaryFolder parent;
  const ProductFolder folder(parent.path() / "results", ExistingProducts::kRefuse);
  write_text_file(folder.file("truth/stars.csv"), "abc");
  write_text_file(folder.file("plan.txt"), "");
  write_text_file(folder.file("run.json"), "{}");
  const auto products = folder.products();
  ASSERT_EQ(products.size(), 2U);
  EXPECT_EQ(products[0].path, "plan.txt");
  EXPECT_EQ(products[1].path, "truth/stars.csv");
  EXPECT_EQ(products[1].bytes, 3U);
  EXPECT_EQ(products[1].sha256, sha256("abc"));
  const auto with_known = folder.products({{"plan.txt", "known"}, {"absent.txt", "ignored"}});
  ASSERT_EQ(with_known.size(), 2U);
  EXPECT_EQ(with_known[0].sha256, "known");
  EXPECT_EQ(with_known[1].sha256, sha256("abc"));
}

TEST(ProductFolder, NamesPathAndCauseWhereItMayNotWrite) {
  const test::TemporaryFolder parent;
  parent.write("file", "x");
  EXPECT_THAT([&] { ProductFolder(parent.path() / "file" / "results", ExistingProducts::kRefuse); },
              ThrowsMessage<EnvironmentError>(HasSubstr("results")));
  if (geteuid() == 0) return;  // root may write everywhere
  EXPECT_THAT([&] { ProductFolder("/proc/results", ExistingProducts::kRefuse); },
              ThrowsMessage<EnvironmentError>(HasSubstr("/proc/results")));
}

// Examples of FIPS 180-2, appendix B.
TEST(Sha256, GivesTheDigestsOfTheStandard) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const test::TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_THROW((void)sha256_of_file(folder.path() / "absent"), EnvironmentError);
}

}  // namespace
}  // namespace astroid
