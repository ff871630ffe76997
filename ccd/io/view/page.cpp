#include <algorithm>
#include <array>
#include <bit>
#include <ccd/bodies/steps.hpp>
#include <ccd/contact.hpp>
#include <ccd/io/step_view.hpp>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "ccd/io/view/view_files.hpp"

namespace ccd::io {

// Generated from the files in page/ by the build.
extern const std::string_view page_template, page_camera, page_picture, page_bodies, page_script;

namespace {

template <class Number>
void append_number(std::string& bytes, Number number) {
    auto text = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(text);
    bytes.append(text.data(), text.size());
}

template <class Rows>
std::string bytes_of_rows(const Rows& rows) {
    std::string bytes;
    for (const auto& row : rows)
        for (const auto number : row) append_number(bytes, number);
    return bytes;
}

/// Appends an array, which the page's script finds by `id`.
void append_array(std::string& text, std::string_view id, std::string bytes) {
    text += "<script type=\"text/plain\" id=\"array-";
    text += id;
    text += "\">";
    detail::append_base64(text, std::move(bytes));
    text += "</script>\n";
}

/// The index of each vertex's connected part of the mesh, modulo the number of the page's colours.
std::string bytes_of_parts(const step_view& step) {
    constexpr int colours = 6;
    std::string bytes;
    for (const int part : connected_parts(step.faces, step.edges, step.positions.vertices))
        bytes += static_cast<char>(part % colours);
    return bytes;
}

template <kind K>
std::string bytes_of_contacts(const step_view& step) {
    std::string bytes;
    const auto& times = step.times.of<K>();
    if (times.empty()) return bytes;
    for (const first_contact& contact : first_contacts(step.positions, step.pairs.of<K>(), times)) {
        for (const double weight : contact.weights)
            append_number(bytes, static_cast<float>(weight));
        for (const double n : {contact.normal.x, contact.normal.y, contact.normal.z})
            append_number(bytes, static_cast<float>(n));
    }
    return bytes;
}

/// Vertices, relations, and for crossing pairs the ends of the common segment, if known.
void append_intersections(std::string& text, std::span<const intersection> all,
                          intersection_kind kind) {
    std::string vertices, relations, segments;
    for (const intersection& pair : all) {
        if (pair.kind() != kind) continue;
        for (const mesh_element& element : {pair.a, pair.b})
            for (const vertex_index v : element.vertices()) append_number(vertices, v);
        relations += static_cast<char>(pair.relation);
        for (std::size_t i = 0; i < 6; ++i)
            append_number(segments, pair.segment ? (*pair.segment)[i / 3].position[i % 3]
                                                 : std::numeric_limits<double>::quiet_NaN());
    }
    const std::string id = "start_" + std::string(name(kind));
    append_array(text, id, std::move(vertices));
    append_array(text, id + "_relations", std::move(relations));
    append_array(text, id + "_segments", std::move(segments));
}

/// Bodies that turn, for bodies.js: then positions are those at rest. Empty for all other steps.
struct body_arrays {
    std::string motions, ends;
};

std::string arrays_of(const step_view& step, const body_arrays& bodies) {
    std::string text;
    const std::size_t vertices = step.positions.vertices;
    const auto rows = [vertices](const double* frame) {
        return std::span(reinterpret_cast<const std::array<double, 3>*>(frame), vertices);
    };
    append_array(text, "before", bytes_of_rows(rows(step.positions.before)));
    append_array(text, "after", bytes_of_rows(rows(step.positions.after)));
    append_array(text, "motions", bodies.motions);
    append_array(text, "ends", bodies.ends);
    append_array(text, "faces", bytes_of_rows(step.faces));
    append_array(text, "edges", bytes_of_rows(step.edges));
    append_array(text, "parts", bytes_of_parts(step));
    for_each_kind([&]<kind K>() {
        std::string pairs, times;
        for (const auto& pair : step.pairs.of<K>())
            for (const vertex_index v : vertices_of(pair)) append_number(pairs, v);
        for (const first_time& time : step.times.of<K>())
            for (const double end : {time.low, time.high}) append_number(times, end);
        const std::string id(name(K));
        append_array(text, id, std::move(pairs));
        append_array(text, id + "_times", std::move(times));
        append_array(text, id + "_contacts",
                     bodies.ends.empty() ? bytes_of_contacts<K>(step) : std::string());
    });
    for (const intersection_kind k : intersection_kinds)
        append_intersections(text, step.intersections, k);
    return text;
}

std::string page_of_arrays(std::string_view arrays, std::string_view subject) {
    const std::pair<std::string_view, std::string_view> parts[] = {
        {"{{subject}}", subject},      {"{{arrays}}", arrays},      {"{{camera}}", page_camera},
        {"{{picture}}", page_picture}, {"{{bodies}}", page_bodies}, {"{{script}}", page_script},
    };
    std::string text;
    std::string_view rest = page_template;
    for (const auto& [place, part] : parts) {
        const std::size_t at = rest.find(place);
        text.append(rest.substr(0, at)).append(part);
        rest.remove_prefix(at + place.size());
    }
    return text.append(rest);
}

std::string bytes_of_motion(const body_motion& motion) {
    std::array<double, 25> row{};  // as in bodies.js
    const auto set = [&row](std::size_t at, std::initializer_list<double> numbers) {
        std::ranges::copy(numbers, &row[at]);
    };
    if (const auto* m = std::get_if<rigid_motion>(&motion)) {
        set(0, {1, m->q0.w, m->q0.x, m->q0.y, m->q0.z, m->q1.w, m->q1.x, m->q1.y, m->q1.z});
        set(9, {m->centre.x, m->centre.y, m->centre.z});
        set(19, {m->p0.x, m->p0.y, m->p0.z, m->p1.x, m->p1.y, m->p1.z});
    } else {
        const auto* given = std::get_if<affine_motion>(&motion);
        const affine_motion affine = given ? *given : affine_motion{};
        for (std::size_t i = 0; i < 3; ++i) {
            std::ranges::copy(affine.a0[i], &row[1 + 3 * i]);
            std::ranges::copy(affine.a1[i], &row[10 + 3 * i]);
        }
        set(19, {affine.p0.x, affine.p0.y, affine.p0.z, affine.p1.x, affine.p1.y, affine.p1.z});
    }
    return bytes_of_rows(std::span(&row, 1));
}

}  // namespace

std::string page_of(const body_steps& steps, std::span<const body_motion> motions,
                    const body_step_result& found) {
    mesh all;
    body_arrays bodies;
    for (std::size_t b = 0; b < steps.bodies(); ++b) {
        const mesh& rest = steps.rest(b);
        const vertex_index first = steps.first_vertex(b);
        all.vertices.insert(all.vertices.end(), rest.vertices.begin(), rest.vertices.end());
        for (face f : rest.faces) {
            for (vertex_index& v : f) v += first;
            all.faces.push_back(f);
        }
        for (edge e : rest.edges) {
            for (vertex_index& v : e) v += first;
            all.edges.push_back(e);
        }
        bodies.motions += bytes_of_motion(motions[b]);
        append_number(bodies.ends, steps.first_vertex(b + 1));
    }
    std::vector<intersection> crossing;
    for (const auto& [e, f] : found.crossing_at_start)
        crossing.push_back({{2, {e[0], e[1]}}, {3, f}, errbound::relation::crossing});
    const step_view step{.positions = vertex_rows(all, all),
                         .faces = all.faces,
                         .edges = all.edges,
                         .pairs = found.pairs,
                         .times = found.times,
                         .intersections = crossing};
    detail::require_view(step);
    return page_of_arrays(arrays_of(step, bodies), "bodies");
}

std::string page_of(const step_view& step) {
    detail::require_view(step);
    return page_of_arrays(arrays_of(step, {}), "a mesh");
}

}  // namespace ccd::io
