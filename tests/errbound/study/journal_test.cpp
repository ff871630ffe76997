// Journals give back what was written, or the first part of it, whatever happened to the file.
#include "errbound/study/journal.hpp"

#include <gtest/gtest.h>

#include <errbound/support/error.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "tests/support/files.hpp"

namespace {

using errbound::study::chunk_result;
using errbound::study::journal;
using errbound::support::read_whole;
using errbound::support::write_whole;
using test_files::message_of;
using test_files::temporary_directory;
namespace fs = std::filesystem;

using results = std::vector<chunk_result>;

const std::string study = "sums, seed 1, 10 chunks";
const results some = {{0, "a"}, {2, ""}, {18446744073709551615U, "[1, \"two words\"]"}};

std::string contents(const fs::path& file) {
    { journal(file, study).append(some); }
    return read_whole(file);
}

/// Whether they are the first of those.
bool begin(const results& found, const results& all) {
    return found.size() <= all.size() && std::equal(found.begin(), found.end(), all.begin());
}

TEST(Journal, KeepsResultsInTheirOrder) {
    const temporary_directory directory;
    const fs::path file = directory.path / "kept";
    EXPECT_TRUE(journal(file, study).take_results().empty());
    EXPECT_TRUE(journal(file, study).take_results().empty());
    {
        journal j(file, study);
        j.append({some[0]});
        j.append({});
        j.append({some[1], some[2]});
    }
    journal again(file, study);
    EXPECT_EQ(again.take_results(), some);
    EXPECT_THROW(again.append({{3, "two\nlines"}}), std::logic_error);
    again.append({{4, "more"}});
    again.remove();
    EXPECT_FALSE(fs::exists(file));
}

TEST(Journal, IsGoodUpToWhereItIsTorn) {
    const temporary_directory directory;
    const fs::path file = directory.path / "kept";
    const std::string whole = contents(file);
    const std::size_t first_line = whole.find('\n') + 1;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        SCOPED_TRACE(size);
        write_whole(file, whole.substr(0, size));
        if (size > 0 && size < first_line) {  // also the beginning of a first line is one's own
            EXPECT_TRUE(journal(file, study).take_results().empty());
            continue;
        }
        {
            journal j(file, study);
            const results found = j.take_results();
            EXPECT_TRUE(begin(found, some));
            EXPECT_LT(found.size(), some.size());
            j.append({{7, "after"}});
        }
        const results repaired = journal(file, study).take_results();
        ASSERT_FALSE(repaired.empty());
        EXPECT_EQ(repaired.back(), chunk_result(7, "after"));
    }
}

TEST(Journal, TakesNoDamagedLineForAResult) {
    const temporary_directory directory;
    const fs::path file = directory.path / "kept";
    const std::string whole = contents(file);
    for (std::size_t place = 0; place < whole.size(); ++place)
        for (const char change : {'\x01', '\x20', '\x80'}) {
            SCOPED_TRACE(place);
            std::string damaged = whole;
            damaged[place] = static_cast<char>(damaged[place] ^ change);
            write_whole(file, damaged);
            try {
                EXPECT_TRUE(begin(journal(file, study).take_results(), some));
            } catch (const errbound::support::file_error&) {
                EXPECT_EQ(read_whole(file), damaged);  // refused, and left as it was
            }
        }
}

TEST(Journal, RefusesWhatIsNotItsOwn) {
    const temporary_directory directory;
    const fs::path file = directory.path / "kept";
    const auto refusal = [](const fs::path& path, const std::string& identity) {
        return message_of([&] { const journal opened(path, identity); });
    };
    contents(file);
    EXPECT_NE(refusal(file, "sums, seed 2, 10 chunks").find("found the journal of another study"),
              std::string::npos);
    EXPECT_NE(refusal(file, "sums, seed 2, 10 chunks").find("study, seed 1, expected seed 2"),
              std::string::npos)
        << refusal(file, "sums, seed 2, 10 chunks");
    {
        const journal open(file, study);
        EXPECT_NE(refusal(file, study).find("found the journal of a run that has not ended"),
                  std::string::npos);
    }
    EXPECT_EQ(journal(file, study).take_results(), some);
    EXPECT_NE(refusal("/dev/null", study).find("found no regular file"), std::string::npos);
    EXPECT_NE(refusal(directory.path, study).find("found no regular file"), std::string::npos);
    EXPECT_NE(refusal(directory.path / "no" / "kept", study).find("cannot be written"),
              std::string::npos);
    write_whole(file, "t,x\n0,1\n");
    EXPECT_NE(refusal(file, study).find(":1: found no journal of a study"), std::string::npos);
    EXPECT_EQ(read_whole(file), "t,x\n0,1\n");
}

TEST(Journal, ALinkStaysOne) {
    const temporary_directory directory;
    const fs::path file = directory.path / "kept", link = directory.path / "link";
    contents(file);
    fs::create_symlink("kept", link);
    journal j(link, study);
    EXPECT_EQ(j.take_results(), some);
    j.remove();
    EXPECT_FALSE(fs::exists(file));
}

}  // namespace
