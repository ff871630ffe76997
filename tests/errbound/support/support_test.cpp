// Output files are whole or untouched; scratch files are removed; decimals are read; doubles are
// written as exact text.
#include <gtest/gtest.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <system_error>

#include "errbound/support/decimal.hpp"
#include "errbound/support/hexadecimal.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/scratch_file.hpp"
#include "errbound/support/table.hpp"
#include "tests/support/files.hpp"
#include "tests/support/scaled.hpp"

namespace {

using namespace errbound::support;
using test_files::files_in;
using test_files::message_of;
using test_files::temporary_directory;
using test_files::write;
namespace fs = std::filesystem;

template <class Call>
void expect_refusal(const Call& call, const std::string& part_of_message) {
    const std::string message = message_of(call);
    EXPECT_NE(message.find(part_of_message), std::string::npos) << message;
}

TEST(Output, IsWholeOrNotWritten) {
    const temporary_directory directory;
    const fs::path file = directory.path / "out";
    write_whole(file, "one");
    write_whole(file, "two\n");
    EXPECT_EQ(read_whole(file), "two\n");
    expect_refusal([&] { write_whole(directory.path, "x"); }, "is a directory");
    expect_refusal([&] { write_whole(directory.path / "no" / "out", "x"); }, "cannot be written");
    expect_refusal([&] { write_whole("", "x"); }, "no file name");
    EXPECT_EQ(files_in(directory.path), 1);
}

TEST(Output, StopsAtTheFirstFailure) {
    const temporary_directory directory;
    const fs::path first = directory.path / "first", last = directory.path / "last";
    write_whole(last, "as it was");
    expect_refusal(
        [&] {
            write_whole({{first, "new"}, {directory.path, "new"}, {last, "new"}});
        },
        "is a directory");
    EXPECT_EQ(read_whole(first), "new");
    EXPECT_EQ(read_whole(last), "as it was");
    EXPECT_EQ(files_in(directory.path), 2);
}

TEST(Output, NamesOfAnyAlphabet) {
    const temporary_directory directory;
    for (const char8_t* const name :
         {u8"\u00e9t\u00e9", u8"\u03a9", u8"\u65e5\u672c", u8"\U0001d400"}) {
        const fs::path file = directory.path / name;
        require_writable(file);
        write_whole(file, "one");
        write_whole(file, "two");
        EXPECT_EQ(read_whole(file), "two");
        ASSERT_EQ(files_in(directory.path), 1);
        EXPECT_EQ(fs::directory_iterator(directory.path)->path().filename(), fs::path(name));
        fs::remove(file);
    }
}

TEST(Output, ToBadPathsIsRefusedEarly) {
    const temporary_directory directory;
    const auto expect_refused = [](const fs::path& path, const std::string& part_of_message) {
        expect_refusal([&] { require_writable(path); }, part_of_message);
    };
    write_whole(directory.path / "file", "one");
    for (const fs::path& good : {fs::path("here"), fs::path("-"), fs::path("/dev/null"),
                                 directory.path / "new", directory.path / "file"})
        EXPECT_NO_THROW(require_writable(good)) << good;
    expect_refused(directory.path, "is a directory");
    expect_refused(directory.path / "no" / "out", "No such file");
#ifndef _WIN32  // Windows reports this only when the file is made
    const std::string too_long = std::generic_category().message(ENAMETOOLONG);
    expect_refused(directory.path / std::string(300, 'n'), "cannot be written (" + too_long);
#endif
    expect_refused(directory.path / "file" / "out", "cannot be written");
    EXPECT_EQ(read_whole(directory.path / "file"), "one");
}

TEST(Output, KeepsLinksAndDevices) {
    const temporary_directory directory;
    const fs::path file = directory.path / "out", link = directory.path / "link";
    write_whole(file, "one");
    if (!test_files::link("out", link)) GTEST_SKIP() << "no symbolic links";
    write_whole(link, "two");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(read_whole(file), "two");
    write_whole("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

/// A file named "\x1b[2J.csv" cleared the screen.
TEST(Table, PrintsControlCharactersAsNumbers) {
    using errbound::support::printable;
    EXPECT_EQ(printable("\x1b[2J.csv\n\x7f"), "\\x1b[2J.csv\\x0a\\x7f");
    EXPECT_EQ(printable("a\nb\tc", "\n"), "a\nb\\x09c");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m \xc3\x9b \xc2\xa0"),
              "\\xc2\\x9b31m \xc3\x9b \xc2\xa0");
    EXPECT_EQ(errbound::support::text_of({{"file", "n"}, {"a\rb", "1"}}, 1),
              "file    n\na\\x0db  1\n");
}

TEST(Scratch, IsReadBackAndRemoved) {
    fs::path path;
    {
        scratch_file file, other;
        path = file.path();
        EXPECT_NE(path, other.path());
        EXPECT_TRUE(fs::exists(path));
        const std::string large(3'000'000, 'x');
        file.append("abc");
        file.append({});
        file.append(large);
        file.append("end");
        std::string read(large.size() + 6, '?');
        file.read(0, read.size(), read.data());
        EXPECT_EQ(read, "abc" + large + "end");
        file.read(1, 2, read.data());
        EXPECT_EQ(read.substr(0, 3), "bcc");
        file.read(read.size(), 0, read.data());
        expect_refusal([&] { file.read(read.size() - 2, 3, read.data()); },
                       path.string() + ": cannot be read (it was cut off)");
    }
    EXPECT_FALSE(fs::exists(path));
}

#ifndef _WIN32  // Windows always has a folder
TEST(Scratch, NeedsAFolder) {
    const temporary_directory directory;
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    setenv("TMPDIR", (directory.path / "no").c_str(), 1);
    expect_refusal([] { const scratch_file file; }, "TMPDIR is not usable");
    if (before)
        setenv("TMPDIR", kept.c_str(), 1);
    else
        unsetenv("TMPDIR");
}
#endif

template <class T>
void expect_decimal(std::string_view text, T value) {
    const decimal<T> read = parse_decimal<T>(text);
    EXPECT_EQ(read.status, decimal_status::ok) << text;
    EXPECT_EQ(read.value, value) << text;
    EXPECT_EQ(std::signbit(read.value), std::signbit(value)) << text;
}

TEST(Decimal, IsTheNearestNumber) {
    expect_decimal("0.1", 0.1);
    expect_decimal("-2.5e-3", -2.5e-3);
    expect_decimal(".5", 0.5);
    expect_decimal("5.", 5.0);
    expect_decimal("-0", -0.0);
    expect_decimal("9007199254740993", 9007199254740992.0);
    expect_decimal("9007199254740993.000000000000000000001", 9007199254740994.0);
    expect_decimal("16777217", 16777216.0F);
    expect_decimal("16777217.0000000000001", 16777218.0F);  // not by way of double
    expect_decimal("1.7976931348623157e308", std::numeric_limits<double>::max());
    expect_decimal("4.9e-324", 0x1p-1074);
    expect_decimal("2e-320", 2e-320);
    expect_decimal("1e-45", 0x1p-149F);
    expect_decimal("1e-400", 0.0);
    expect_decimal("-1e-99999999999", -0.0);
    expect_decimal("1e-50", 0.0F);
    expect_decimal("-inf", -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(parse_decimal<double>("nan").value));
}

TEST(Decimal, OtherTextsAreRefused) {
    for (const char* text :
         {"", "-", ".", "+1", "--1", "1 ", " 1", "1e", "1e+", "e5", "1.5.", "0x1", "1,5", "x"})
        EXPECT_EQ(parse_decimal<double>(text).status, decimal_status::malformed) << text;
    for (const char* text : {"1e309", "-1e309", "1.7976931348623159e308", "1e99999999999"})
        EXPECT_EQ(parse_decimal<double>(text).status, decimal_status::overflow) << text;
    EXPECT_EQ(parse_decimal<float>("3.5e38").status, decimal_status::overflow);
}

TEST(Hexadecimal, IsTheSameOnEverySystem) {
    EXPECT_EQ(hexadecimal(1), "0x1p+0");
    EXPECT_EQ(hexadecimal(-0.1), "-0x1.999999999999ap-4");
    EXPECT_EQ(hexadecimal(0x1p52 + 1), "0x1.0000000000001p+52");
    EXPECT_EQ(hexadecimal(0), "0x0p+0");
    EXPECT_EQ(hexadecimal(-0.0), "-0x0p+0");
    using limits = std::numeric_limits<double>;
    EXPECT_EQ(hexadecimal(limits::denorm_min()), "0x0.0000000000001p-1022");
    EXPECT_EQ(hexadecimal(limits::min() / 2), "0x0.8p-1022");
    EXPECT_EQ(hexadecimal(limits::min()), "0x1p-1022");
    EXPECT_EQ(hexadecimal(limits::max()), "0x1.fffffffffffffp+1023");
    EXPECT_EQ(hexadecimal(-limits::infinity()), "-inf");
    EXPECT_EQ(hexadecimal(limits::quiet_NaN()), "nan");
}

TEST(Hexadecimal, IsReadBackAsTheSameNumber) {
    std::mt19937_64 random(1);
    for (int i = 0; i < support::scaled(100000); ++i) {
        std::uint64_t bits = random();
        if (i % 4 == 0) bits &= ~(std::uint64_t(0x7ff) << 52);       // below the least normal one
        if (i % 3 == 0) bits &= ~std::uint64_t(0) << random() % 53;  // zeros at the end
        const double x = std::bit_cast<double>(bits);
        if (!std::isfinite(x)) continue;
        const std::string text = hexadecimal(x);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)), bits) << text;
#ifdef __GLIBC__
        char printed[64];
        std::snprintf(printed, sizeof printed, "%a", x);
        ASSERT_EQ(text, printed);
#endif
    }
}

}  // namespace
