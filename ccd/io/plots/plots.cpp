#include "ccd/io/plots/plots.hpp"

#include <string_view>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace ccd::io {

extern const std::string_view plot_script;  // plot.py, by the build

namespace {

using nlohmann::ordered_json;

std::string field_of(const ordered_json& value) {
    // A path need not be UTF-8.
    if (!value.is_string())
        return value.is_null() ? ""
                               : value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    const std::string text = value.get<std::string>();
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

}  // namespace

const std::vector<std::string> method_columns{"data_set",   "origin",          "kind",
                                              "method",     "queries",         "colliding",
                                              "collisions", "false_positives", "false_negatives",
                                              "uncertain",  "timed",           "ns_min",
                                              "ns_median"};

std::string csv_of(const std::vector<std::string>& columns, const std::vector<ordered_json>& rows) {
    std::string text;
    for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
    text += '\n';
    for (const ordered_json& row : rows) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (i > 0) text += ',';
            if (row.contains(columns[i])) text += field_of(row[columns[i]]);
        }
        text += '\n';
    }
    return text;
}

int draw_pictures(const std::filesystem::path& folder) {
    const std::filesystem::path script = folder / "plot.py";
    errbound::support::write_whole(script, plot_script);
    // Distribution packages belong to the distribution's Python, which need not be the first on
    // PATH.
    int status = no_python;
    for (const char* python : {"/usr/bin/python3", "python3", "python"})
        if (status == no_python) status = errbound::support::system::run(python, script.string());
    return status;
}

}  // namespace ccd::io
