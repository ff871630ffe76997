// Stores of queries in a build without HDF5: every use is an error.
#include <ccd/io/query_store.hpp>
#include <errbound/support/error.hpp>
#include <stdexcept>

#include "ccd/io/store/store_reader.hpp"

namespace ccd::io {

void leave_stores_at_exit() {}

std::unique_ptr<store_reader> open_store(const std::filesystem::path& path) {
    return open_store({}, path.string());
}

std::unique_ptr<store_reader> open_store(std::string_view, const std::string& name) {
    throw errbound::support::file_error(
        name + ": file is an HDF5 store; expected CSV, since this was built without HDF5");
}

bool has_query_stores() {
    return false;
}

std::unique_ptr<query_packer> make_query_packer(ccd::kind, bool) {
    throw std::runtime_error("stores cannot be written, since this was built without HDF5");
}

}  // namespace ccd::io
