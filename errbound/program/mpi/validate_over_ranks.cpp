// `errbound validate` over ranks: a study whose chunks are those of all parts, one after another.
#include "errbound/program/mpi/validate_over_ranks.hpp"

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "errbound/program/mpi/report_line.hpp"
#include "errbound/program/validate_command.hpp"
#include "errbound/program/validate_results.hpp"
#include "errbound/study/options.hpp"
#include "errbound/support/command_line.hpp"

namespace errbound::validation {
namespace {

using ccd::io::query_file;
using nlohmann::ordered_json;

std::string bytes_of(const query_file& file) {
    return std::visit(
        [](const auto& queries) {
            return std::string(reinterpret_cast<const char*>(queries.data()),
                               queries.size() * sizeof queries[0]);
        },
        file.queries);
}
template <class Query>
std::vector<Query> queries_of(const std::string& bytes) {
    static_assert(std::is_trivially_copyable_v<Query>);
    std::vector<Query> queries(bytes.size() / sizeof(Query));
    if (!queries.empty()) std::memcpy(queries.data(), bytes.data(), bytes.size());
    return queries;
}

/// Rank 0 reads the files, which may be pipes, and tells all what is in them.
std::vector<query_file> shared_files(MPI_Comm comm, const validate_arguments& arguments) {
    std::vector<query_file> files;
    study::on_root(comm, [&] { files = read_files(arguments); });
    files.resize(arguments.queries.size());
    for (query_file& file : files) {
        const std::string kind = study::broadcast(comm, std::string(name(file.kind())));
        const std::string bytes = study::broadcast(comm, bytes_of(file));
        if (kind == name(ccd::kind::vertex_face))
            file.queries = queries_of<ccd::vertex_face<double>>(bytes);
        else
            file.queries = queries_of<ccd::edge_edge<double>>(bytes);
    }
    return files;
}

/// All that results depend on.
std::string identity_of(const validate_arguments& arguments, const std::vector<query_file>& files) {
    ordered_json all{
        {"study", "errbound validate"}, {"version", ERRBOUND_VERSION}, {"tiny", arguments.tiny}};
    if (arguments.every_bound) all["every bound"] = true;
    for (const number_type number : arguments.options.numbers)
        all["numbers"].push_back(name_of(number));
    if (arguments.expressions)
        all["expressions"] = {arguments.options.expressions, arguments.options.operations,
                              arguments.options.seed};
    const function_options& functions = arguments.functions;
    for (const elementary_function f : functions.functions) all["functions"].push_back(name_of(f));
    if (!functions.functions.empty())
        all["arguments"] = {functions.samples, functions.every_float, functions.seed,
                            functions.units.value_or(0)};
    for (const rule& r : arguments.rules) all["rules"].push_back(r.name);
    for (std::size_t i = 0; i < files.size(); ++i) {
        boost::crc_32_type checksum;
        const std::string bytes = bytes_of(files[i]);
        checksum.process_bytes(bytes.data(), bytes.size());
        all["files"].push_back({{"name", arguments.queries[i].string()},
                                {"kind", name(files[i].kind())},
                                {"queries", files[i].size()},
                                {"checksum", checksum.checksum()}});
    }
    return all.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
}

/// The study's chunks: those of all parts.
class chunk_list {
  public:
    explicit chunk_list(std::vector<part> parts) : parts_(std::move(parts)) {
        for (const part& p : parts_) all_ += p.what.chunks;
    }
    std::uint64_t size() const { return all_; }

    std::string line_of(std::uint64_t chunk) const {
        auto p = parts_.begin();
        for (; chunk >= p->what.chunks; ++p) chunk -= p->what.chunks;
        return report_line(p->what.report_of(chunk));
    }
    std::vector<found_part> found(const std::vector<std::string>& lines) const {
        std::vector<found_part> all;
        std::size_t line = 0;
        for (const part& p : parts_) {
            report sum;
            for (std::uint64_t c = 0; c < p.what.chunks; ++c) sum.merge(report_from(lines[line++]));
            p.what.tell(sum);
            all.push_back({p.name, std::move(sum)});
        }
        return all;
    }

  private:
    std::vector<part> parts_;
    std::uint64_t all_ = 0;
};

}  // namespace

exit_status validate_over_ranks(MPI_Comm comm, const validate_arguments& arguments,
                                const std::optional<std::filesystem::path>& journal) {
    study::on_root(comm, [&] {
        support::require_good_outputs(
            {arguments.json, arguments.csv, arguments.functions_csv, journal}, arguments.queries);
    });
    const std::vector<query_file> files = shared_files(comm, arguments);
    const chunk_list chunks(parts_of(arguments, files));
    study::study all(comm,
                     {.program = "errbound_mpi",
                      .identity = identity_of(arguments, files),
                      .chunks = chunks.size(),
                      .work = {[&](std::uint64_t chunk) { return chunks.line_of(chunk); },
                               arguments.options.threads}},
                     journal);
    return run_study(all, stopped, [&](const std::vector<std::string>& lines) {
        return write_results(chunks.found(lines), arguments);
    });
}

}  // namespace errbound::validation
