// Output files are written whole or not at all.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "errbound/support/output_file.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace errbound::support;
using test_files::message_of;
using test_files::temporary_directory;
using test_files::write;
namespace fs = std::filesystem;

TEST(Output, WholeOrNotAtAll) {
    const temporary_directory directory;
    const fs::path file = directory.path / "out";
    write_whole(file, "one");
    write_whole(file, "two\n");
    EXPECT_EQ(read_whole(file), "two\n");
    EXPECT_NE(message_of([&] { write_whole(directory.path, "x"); }).find("found a directory"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  write_whole(directory.path / "no" / "out", "x");
              }).find("cannot be written"),
              std::string::npos);
    EXPECT_NE(message_of([&] { write_whole("", "x"); }).find("no file name"), std::string::npos);
    // Nothing but the file itself is left.
    EXPECT_EQ(std::distance(fs::directory_iterator(directory.path), fs::directory_iterator{}), 1);
}

TEST(Output, IsRefusedBeforeThereIsAnythingToWrite) {
    const temporary_directory directory;
    const auto refusal = [](const fs::path& path) {
        return message_of([&] { errbound::support::require_writable(path); });
    };
    write_whole(directory.path / "file", "one");
    for (const fs::path& good : {fs::path("here"), fs::path("-"), fs::path("/dev/null"),
                                 directory.path / "new", directory.path / "file"})
        EXPECT_EQ(refusal(good), "no error") << good;
    EXPECT_NE(refusal(directory.path).find("found a directory"), std::string::npos);
    EXPECT_NE(refusal(directory.path / "no" / "out").find("No such file"), std::string::npos);
    EXPECT_NE(refusal(directory.path / std::string(300, 'n')).find("cannot be written (File name"),
              std::string::npos);
    EXPECT_NE(refusal(directory.path / "file" / "out").find("cannot be written"),
              std::string::npos);
    EXPECT_EQ(read_whole(directory.path / "file"), "one");
}

TEST(Output, LinksAndDevicesStayWhatTheyAre) {
    const temporary_directory directory;
    const fs::path file = directory.path / "out", link = directory.path / "link";
    write_whole(file, "one");
    fs::create_symlink("out", link);
    write_whole(link, "two");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(read_whole(file), "two");
    write_whole("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
