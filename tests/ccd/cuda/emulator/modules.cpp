#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "tests/ccd/cuda/emulator/device.hpp"

namespace ptx {
namespace {

/// FNV-1a of eight bytes at a time, in hexadecimal.
std::string hash(std::string_view text) {
    u64 h = 0xcbf29ce484222325;
    for (; !text.empty(); text.remove_prefix(std::min<std::size_t>(8, text.size()))) {
        u64 word = 0;
        std::memcpy(&word, text.data(), std::min<std::size_t>(8, text.size()));
        h = (h ^ word) * 0x100000001b3;
        h ^= h >> 32;
    }
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(h));
    return digits;
}

/// Writes a file that other processes may be writing, too.
void write_once(const std::string& name, const std::string& text) {
    if (std::filesystem::exists(name)) return;
    const std::string own = name + "." + std::to_string(getpid());
    std::ofstream(own, std::ios::binary) << text;
    std::filesystem::rename(own, name);
}

}  // namespace

module::module(const unsigned char* fatbinary) {
    const u16 header = ptx::load<u16>(reinterpret_cast<const char*>(fatbinary) + 6);
    const u64 size = ptx::load<u64>(reinterpret_cast<const char*>(fatbinary) + 8);
    const char* at = reinterpret_cast<const char*>(fatbinary) + header;
    for (const char* const end = at + size; at < end;) {
        const auto kind = ptx::load<u16>(at);
        const auto entry_header = ptx::load<u32>(at + 4);
        const auto bytes = ptx::load<u64>(at + 8);
        constexpr u16 kind_ptx = 1;
        if (kind == kind_ptx) ptx_.assign(at + entry_header, bytes);
        at += entry_header + bytes;
    }
    ptx_ = ptx_.substr(0, ptx_.find('\0'));
    const char* const cache = std::getenv("PTXEMU_CACHE");
    folder_ = std::string(cache ? cache : PTXEMU_DEFAULT_CACHE) + "/" PTXEMU_TRANSLATOR_HASH "/" +
              hash(ptx_);
}

void* module::load(const std::string& name) {
    if (ptx_.find(".version") == std::string::npos)
        stop(
            "the program has no PTX in plain text; compile it for a virtual architecture with "
            "--no-compress");
    const std::string object = folder_ + "/" + hash(name) + ".so";
    if (!std::filesystem::exists(object)) {
        std::filesystem::create_directories(folder_);
        write_once(file(), ptx_);
        const std::string command = PTXEMU_PYTHON " " PTXEMU_FOLDER "/translate.py '" + file() +
                                    "' '" + name + "' '" + object + "' " PTXEMU_COMPILER;
        if (std::system(command.c_str()) != 0) stop("failed: %s", command.c_str());
    }
    void* const library = dlopen(object.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) stop("%s", dlerror());
    for (auto* v =
             static_cast<const variable*>(dlsym(library, ("variables_" + hash(name)).c_str()));
         v->name != nullptr; ++v) {
        u64& address = variables_[v->name];
        if (address == 0) {
            void* const p = memory().allocate(v->bytes);
            char* const content = memory().content(p, v->bytes, writes);
            std::memset(content, 0, v->bytes);
            if (v->initial != nullptr) std::memcpy(content, v->initial, v->bytes);
            address = reinterpret_cast<u64>(p);
        }
        *v->address = address;
    }
    return dlsym(library, ("translated_" + hash(name)).c_str());
}

const kernel& module::find_kernel(const std::string& name) {
    const kernel*& found = kernels_[name];
    if (found == nullptr) found = static_cast<const kernel*>(load(name));
    return *found;
}

void* module::find_function(const std::string& name) {
    void*& found = functions_[name];
    if (found == nullptr) found = load(name);
    return found;
}

}  // namespace ptx
