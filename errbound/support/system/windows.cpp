// Windows, by the C runtime where that suffices.
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>
#include <windows.h>
// Must follow windows.h.
#include <psapi.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>

#include "errbound/support/system/system.hpp"

namespace errbound::support::system {
namespace {

/// A name in UTF-16; empty, thus invalid, if it is too long.
class wide {
  public:
    explicit wide(const std::string& name) {
        if (MultiByteToWideChar(CP_UTF8, 0, name.c_str(), -1, text_.data(), size) == 0)
            text_[0] = L'\0';
    }
    const wchar_t* c_str() const { return text_.data(); }

  private:
    static constexpr int size = 4096;
    std::array<wchar_t, size> text_{};
};
std::string utf8(const std::filesystem::path& path) {
    const std::u8string name = path.u8string();
    return {name.begin(), name.end()};
}

int rights_of(const std::string& name, int rights) {
    return _waccess(wide(name).c_str(), rights);
}
constexpr int to_exist = 0, to_write = 2;

int open(const std::string& file, int flags) {
    return _wopen(wide(file).c_str(), flags | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}
unsigned at_once(std::size_t size) {
    return static_cast<unsigned>(std::min<std::size_t>(size, INT_MAX));
}

}  // namespace

void start_program() {
    for (std::FILE* standard : {stdin, stdout, stderr}) _setmode(_fileno(standard), _O_BINARY);
}

bool is_terminal(int descriptor) {
    if (_isatty(descriptor) == 0) return false;
    const auto console = reinterpret_cast<HANDLE>(_get_osfhandle(descriptor));
    DWORD mode = 0;
    constexpr DWORD control_sequences = 4;  // ENABLE_VIRTUAL_TERMINAL_PROCESSING
    return GetConsoleMode(console, &mode) != 0 &&
           SetConsoleMode(console, mode | control_sequences) != 0;
}

std::size_t peak_memory_bytes() {
    PROCESS_MEMORY_COUNTERS counters{};
    GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters);
    return counters.PeakWorkingSetSize;
}
double memory_bytes() {
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof status;
    GlobalMemoryStatusEx(&status);
    return static_cast<double>(status.ullTotalPhys);
}
double load() {
    return 0;
}
std::filesystem::path program_file() {
    std::array<wchar_t, 4096> name{};
    const DWORD size = GetModuleFileNameW(nullptr, name.data(), name.size());
    return size < name.size() ? std::filesystem::path(name.data()) : std::filesystem::path();
}
int process_number() {
    return _getpid();
}
int run(const char* program, const std::string& argument) {
    const auto status =
        _spawnlp(_P_WAIT, program, program, ('"' + argument + '"').c_str(), nullptr);
    return status < 0 ? 127 : static_cast<int>(status);
}

const std::string_view separators = "/\\";
const bool has_device_files = false;
std::string native_name(const std::filesystem::path& path) {
    return utf8(path);
}
std::string real_name(const std::string& name) {
    const HANDLE file =
        CreateFileW(wide(name).c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                    nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    std::array<wchar_t, 4096> real{};
    DWORD size = 0;
    if (file != INVALID_HANDLE_VALUE) {
        size = GetFinalPathNameByHandleW(file, real.data(), real.size(), FILE_NAME_NORMALIZED);
        CloseHandle(file);
    }
    if (size > 0 && size < real.size()) return utf8(std::wstring(real.data(), size));
    errno = file == INVALID_HANDLE_VALUE ? ENOENT : EIO;
    return {};
}
bool are_one_name(const std::string& a, const std::string& b) {
    return CompareStringOrdinal(wide(a).c_str(), -1, wide(b).c_str(), -1, TRUE) == CSTR_EQUAL;
}
bool exists(const std::string& name) {
    return rights_of(name, to_exist) == 0;
}
bool may_write(const std::string& file) {
    return rights_of(file, to_write) == 0;
}
bool may_write_in(const std::string& folder) {
    return rights_of(folder, to_write) == 0;
}
bool replace(const std::string& from, const std::string& to) {
    if (MoveFileExW(wide(from).c_str(), wide(to).c_str(), MOVEFILE_REPLACE_EXISTING) != 0)
        return true;
    errno = EACCES;
    return false;
}
bool remove(const std::string& file) {
    return _wunlink(wide(file).c_str()) == 0;
}

int create(const std::string& file) {
    return open(file, _O_WRONLY | _O_CREAT | _O_EXCL);
}
int open_to_write(const std::string& file) {
    return open(file, _O_WRONLY);
}
int create_named(std::string& pattern) {
    std::wstring name = wide(pattern).c_str();
    if (_wmktemp_s(name.data(), name.size() + 1) != 0) return -1;
    pattern = utf8(name);
    return open(pattern, _O_RDWR | _O_CREAT | _O_EXCL | _O_APPEND);
}
int close(int descriptor) {
    return _close(descriptor);
}
std::ptrdiff_t write(int descriptor, const char* from, std::size_t size) {
    return _write(descriptor, from, at_once(size));
}
std::ptrdiff_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t size) {
    OVERLAPPED from{};
    from.Offset = static_cast<DWORD>(offset);
    from.OffsetHigh = static_cast<DWORD>(offset >> 32);
    DWORD got = 0;
    const auto file = reinterpret_cast<HANDLE>(_get_osfhandle(descriptor));
    if (ReadFile(file, to, at_once(size), &got, &from) != 0) return got;
    errno = EIO;
    return GetLastError() == ERROR_HANDLE_EOF ? 0 : -1;
}
void copy_rights(int, const std::string&) {}

int lock(const std::string& folder) {
    const HANDLE file = CreateFileW(wide(folder + "\\.lock").c_str(), GENERIC_WRITE, 0, nullptr,
                                    OPEN_ALWAYS, FILE_FLAG_DELETE_ON_CLOSE, nullptr);
    if (file != INVALID_HANDLE_VALUE) return _open_osfhandle(reinterpret_cast<intptr_t>(file), 0);
    errno = GetLastError() == ERROR_SHARING_VIOLATION ? EWOULDBLOCK : EIO;
    return -1;
}

// Windows has no signals for pipes.
failing_pipes::failing_pipes() : before_(SIG_DFL) {}
failing_pipes::~failing_pipes() = default;

}  // namespace errbound::support::system
