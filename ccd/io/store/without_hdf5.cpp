// What is said of stores where this is built without HDF5.
#include <ccd/io/query_store.hpp>
#include <errbound/support/error.hpp>
#include <stdexcept>

#include "ccd/io/store/store_reader.hpp"

namespace ccd::io {
namespace {

[[noreturn]] void refuse(const std::string& name) {
    throw errbound::support::file_error(
        name + ": found an HDF5 file, expected CSV: this was built without HDF5");
}

}  // namespace

void leave_stores_at_exit() {}

class store_reader::opened {};

store_reader::store_reader(std::string_view, const std::string& name) {
    refuse(name);
}
store_reader::store_reader(const std::filesystem::path& path) {
    refuse(path.string());
}
store_reader::~store_reader() = default;
store_reader::store_reader(store_reader&&) noexcept = default;
store_reader& store_reader::operator=(store_reader&&) noexcept = default;
ccd::kind store_reader::kind() const {
    return {};
}
std::uint64_t store_reader::size() const {
    return 0;
}
query_file store_reader::read(std::uint64_t, std::uint64_t) const {
    return {};
}

bool has_query_stores() {
    return false;
}

class query_packer::chunks {};

query_packer::query_packer(ccd::kind, bool) {
    throw std::runtime_error("stores of queries are not made: this was built without HDF5");
}
query_packer::~query_packer() = default;
query_packer::query_packer(query_packer&&) noexcept = default;
query_packer& query_packer::operator=(query_packer&&) noexcept = default;
void query_packer::add(const query_file&) {}
std::uint64_t query_packer::size() const {
    return 0;
}
const std::filesystem::path& query_packer::finish() {
    static const std::filesystem::path none;
    return none;
}

}  // namespace ccd::io
