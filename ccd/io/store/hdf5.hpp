// HDF5's handles, its errors as exceptions, and the checksum of a chunk of queries.
#pragma once

#include <hdf5.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace ccd::io::hdf5 {

/// While one lives no other call of ours is in the library, which is not for several threads, and
/// it prints nothing; what the process had set is set again.
class quiet_use {
  public:
    quiet_use() : lock_(mutex()) {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~quiet_use() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    quiet_use(const quiet_use&) = delete;
    quiet_use& operator=(const quiet_use&) = delete;

  private:
    static std::recursive_mutex& mutex() {
        static std::recursive_mutex one;
        return one;
    }
    std::unique_lock<std::recursive_mutex> lock_;
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

/// What the library says of its last failure, where it began.
inline std::string reason() {
    std::string said;
    H5Ewalk2(
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
            auto& text = *static_cast<std::string*>(data);
            if (text.empty() && error->desc != nullptr) text = error->desc;
            return 0;
        },
        &said);
    if (said.empty()) return "no reason";
    // Of the system's failures it says much more, on several lines.
    constexpr std::string_view of_system = "error message = '";
    if (const std::size_t at = said.find(of_system); at != std::string::npos) {
        const std::size_t begin = at + of_system.size();
        return said.substr(begin, said.find('\'', begin) - begin);
    }
    return said.substr(0, said.find('\n'));
}

/// Of a call that is negative where it fails. `what` says where: "FILE: dataset points".
template <class Status>
Status checked(Status status, const std::string& what) {
    if (status < 0)
        throw errbound::support::file_error(what + ": cannot be read or made (HDF5: " + reason() +
                                            ")");
    return status;
}

/// Closed in the end.
class handle {
  public:
    handle() = default;
    handle(hid_t id, herr_t (*how)(hid_t), const std::string& what)
        : id_(checked(id, what)), close_(how) {}
    handle(handle&& other) noexcept
        : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    handle& operator=(handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~handle() {
        if (id_ >= 0) close_(id_);
    }
    /// Now, since what is to be written may fail to be.
    void close(const std::string& what) {
        checked(close_(std::exchange(id_, H5I_INVALID_HID)), what);
    }
    operator hid_t() const { return id_; }

  private:
    hid_t id_ = H5I_INVALID_HID;
    herr_t (*close_)(hid_t) = nullptr;
};

}  // namespace ccd::io::hdf5

namespace ccd::io {

/// CRC-32, as zlib's and PNG's, of the bytes of points, queries and truth one after the other, as
/// they are stored. (Stores are built where numbers have their least significant byte first.)
/// HDF5's own, Fletcher32, adds words of 16 bits modulo 65535, so 0x0000 equals 0xffff in it.
inline std::uint32_t checksum(std::span<const std::byte> points, std::span<const std::byte> queries,
                              std::span<const std::byte> truth) {
    uLong sum = crc32_z(0, nullptr, 0);
    for (const std::span<const std::byte> part : {points, queries, truth})
        if (!part.empty())  // of a null pointer crc32_z makes the sum of nothing at all
            sum = crc32_z(sum, reinterpret_cast<const Bytef*>(part.data()), part.size());
    return static_cast<std::uint32_t>(sum);
}

}  // namespace ccd::io
