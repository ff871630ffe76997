#include <algorithm>
#include <ccd/intersections.hpp>
#include <ccd/io/mesh_file.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ccd/io/view/view_files.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/pair_lines.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::program {
namespace {

using errbound::support::fixed;
using errbound::support::table;
using errbound::support::usage_error;

struct checked_file {
    std::string name;
    ccd::mesh mesh;
    std::size_t unused = 0;
    bool skip_unused = false;
    intersection_result found = {};
};

nlohmann::ordered_json json_of(const checked_file& file) {
    nlohmann::ordered_json document = {{"file", file.name},
                                       {"vertices", file.mesh.vertices.size()},
                                       {"faces", file.mesh.faces.size()},
                                       {"free", file.found.is_free()},
                                       {"intersections", nlohmann::ordered_json::object()}};
    for (const intersection_kind k : intersection_kinds)
        for (const errbound::relation r : intersection_relations)
            document["intersections"][std::string(name(k))][std::string(name(r))] =
                file.found.counts.of(k, r);
    document["edge_face"] = file.found.edge_faces.size();
    add_unused(document, file.unused, file.skip_unused);
    document["seconds"] = file.found.seconds;
    return document;
}

std::string text_of(const std::vector<checked_file>& files) {
    table rows = {{"mesh", "faces", "intersections"}};
    for (const errbound::relation r : intersection_relations) rows[0].emplace_back(name(r));
    rows[0].emplace_back("ms");
    for (const checked_file& file : files) {
        auto& row =
            rows.emplace_back(table::value_type{file.name, std::to_string(file.mesh.faces.size()),
                                                std::to_string(file.found.counts.total())});
        for (const errbound::relation r : intersection_relations)
            row.push_back(std::to_string(file.found.counts.of(r)));
        row.push_back(fixed(1e3 * file.found.seconds, "%.1f"));
    }
    return errbound::support::text_of(rows, 1);
}

class check final : public command {
  public:
    explicit check(CLI::App& program)
        : command(program, "check", "Find the intersections of a mesh at rest") {
        add(line_, "FILE", paths_, "PLY or OBJ; -: standard input").required().input();
        add_output(line_, "--pairs", pairs_,
                   "Write lines ff,a0,a1,a2,b0,b1,b2,RELATION of vertex indices (ef, vf, ee,\n"
                   "ve and vv for edges of no face and vertices of neither); RELATION is\n"
                   "crossing, touching or overlapping; one FILE; -: standard output");
        add_output(line_, "--edge-faces", edge_faces_,
                   "Write lines ef,e0,e1,f0,f1,f2 of all edges and faces that share a point\n"
                   "and no vertex; one FILE; -: standard output");
        add_output(line_, "--json", json_,
                   "Write counts as JSON, a list if there are several FILEs; -: standard output");
        add(line_, "--view", view_,
            "Write a page for a browser with the mesh and its intersections; one FILE;\n"
            "-: standard output")
            .ends_in(".html", true);
        add_flag(line_, "--merge-equal-positions", options_.merge_equal_positions,
                 "Count vertices with equal positions as the first of them");
        add_triangulate_option(line_, reading_.triangulate);
        add_threads_option(line_, options_.threads);
    }

    exit_status run() override {
        check_options();
        std::vector<checked_file> files;
        for (const auto& path : paths_) files.push_back(checked(path));
        write(files);
        stream_for_people() << text_of(files);
        const bool free = std::ranges::all_of(
            files, [](const checked_file& file) { return file.found.is_free(); });
        return free ? done : check_failed;
    }

  private:
    std::ostream& stream_for_people() const {
        return errbound::support::stream_for_people({pairs_, edge_faces_, json_, view_});
    }

    void check_options() {
        if (paths_.size() > 1 && (pairs_ || edge_faces_ || view_))
            throw usage_error("number of FILEs is " + std::to_string(paths_.size()) +
                              "; expected one FILE with --pairs, --edge-faces or --view");
        errbound::support::require_good_outputs({pairs_, edge_faces_, json_, view_}, paths_);
        errbound::support::require_one_standard_input("FILE", paths_);
        options_.wanted = pairs_ || view_ ? intersection_options::amount::all
                                          : intersection_options::amount::count;
        options_.segments = view_.has_value();
        options_.edge_faces = edge_faces_ || json_;
    }

    checked_file checked(const std::filesystem::path& path) {
        checked_file file{path.string(), io::read_mesh(path, reading_)};
        const mesh& mesh = file.mesh;
        const std::size_t vertices = mesh.vertices.size();
        file.unused = unused_vertices(mesh.faces, mesh.edges, vertices).size();
        file.skip_unused = unused_.skips(file.unused, vertices);
        stream_for_people() << text_of_unused(file.unused, vertices, file.skip_unused)
                            << std::flush;
        options_.filter.skip_unused = file.skip_unused;
        file.found = intersections(mesh, options_);
        return file;
    }

    void write(const std::vector<checked_file>& files) const {
        const checked_file& first = files.front();
        std::vector<errbound::support::output> outputs;
        if (pairs_) outputs.push_back({*pairs_, lines_of_intersections(first.found.pairs)});
        if (edge_faces_)
            outputs.push_back({*edge_faces_, lines_of_edge_faces(first.found.edge_faces)});
        if (json_) {
            nlohmann::ordered_json document = json_of(first);
            if (files.size() > 1) {
                document = nlohmann::ordered_json::array();
                for (const checked_file& file : files) document.push_back(json_of(file));
            }
            outputs.push_back({*json_, document.dump(2) + '\n'});
        }
        if (view_)
            outputs.push_back({*view_, io::page_of({vertex_rows(first.mesh, first.mesh),
                                                    first.mesh.faces,
                                                    first.mesh.edges,
                                                    {},
                                                    {},
                                                    first.found.pairs})});
        write_whole(outputs);
    }

    std::vector<std::filesystem::path> paths_;
    std::optional<std::filesystem::path> pairs_, edge_faces_, json_, view_;
    io::mesh_options reading_;
    intersection_options options_;
    unused_vertices_option unused_{line_};
};

}  // namespace

const command_maker check_command = make_command<check>;

}  // namespace ccd::program
