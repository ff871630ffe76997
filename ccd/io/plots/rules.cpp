// What a comparison of rules writes: the report's table of methods, a rule and number type a
// method.
#include <ccd/study/rules.hpp>
#include <errbound/support/error.hpp>
#include <system_error>

#include "ccd/io/plots/plots.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::study {

using nlohmann::ordered_json;

bool write_comparison(const std::filesystem::path& folder,
                      const std::vector<compared_file>& files) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw errbound::support::file_error(folder.string() + ": cannot be made a folder (" +
                                            error.message() + ")");
    std::vector<ordered_json> rows;
    for (const compared_file& file : files)
        for (const rule_row& r : file.rows)
            rows.push_back({{"data_set", file.name},
                            {"origin", "stored"},
                            {"kind", short_name(file.kind)},
                            {"method", r.rule + ", " + r.number},
                            {"queries", r.queries},
                            {"colliding", file.colliding},
                            {"collisions", r.collisions},
                            {"false_positives", r.false_positives},
                            {"false_negatives", r.false_negatives},
                            {"uncertain", r.uncertain},
                            {"wrong", r.wrong},
                            {"timed", r.queries},
                            {"ns_min", r.ns_per_query}});
    constexpr auto replace = ordered_json::error_handler_t::replace;  // a path need not be UTF-8
    errbound::support::write_whole(
        {{folder / "methods.csv", io::csv_of(io::method_columns, rows)},
         {folder / "methods.json", ordered_json(rows).dump(1, ' ', false, replace) + '\n'}});
    return io::draw_pictures(folder) == 0;
}

}  // namespace ccd::study
