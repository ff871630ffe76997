// HDF5's handles, and its errors as exceptions.
#pragma once

#include <hdf5.h>

#include <errbound/support/error.hpp>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace ccd::io::hdf5 {

/// Locks the library, which is not thread-safe, and keeps it from printing its errors.
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

/// The innermost cause of the library's last failure, on one line.
inline std::string reason() {
    std::string cause;
    H5Ewalk2(
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
            auto& text = *static_cast<std::string*>(data);
            if (text.empty() && error->desc != nullptr) text = error->desc;
            return 0;
        },
        &cause);
    if (cause.empty()) return "no reason";
    // A failure of the system has several lines, with its message in quotes.
    constexpr std::string_view of_system = "error message = '";
    if (const std::size_t at = cause.find(of_system); at != std::string::npos) {
        const std::size_t begin = at + of_system.size();
        return cause.substr(begin, cause.find('\'', begin) - begin);
    }
    return cause.substr(0, cause.find('\n'));
}

/// Throws file_error if `status` is negative. `where` begins the message: "FILE: dataset points".
template <class Status>
Status checked(Status status, const std::string& where) {
    if (status < 0)
        throw errbound::support::file_error(where + ": cannot be read or made (HDF5: " + reason() +
                                            ")");
    return status;
}

class handle {
  public:
    handle(hid_t id, herr_t (*close)(hid_t), const std::string& where)
        : id_(checked(id, where)), close_(close) {}
    handle(handle&& other) noexcept
        : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    handle& operator=(handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~handle() {
        if (id_ < 0) return;
        const quiet_use use;
        close_(id_);
    }
    /// Closes the handle now. Throws file_error if data cannot be written.
    void close(const std::string& where) {
        checked(close_(std::exchange(id_, H5I_INVALID_HID)), where);
    }
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

}  // namespace ccd::io::hdf5
