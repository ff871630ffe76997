// How our readers of meshes and a peer's are held against each other: both read the same mesh, or
// both refuse, or a listed difference says why not.
#pragma once

#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <ccd/mesh.hpp>
#include <cmath>
#include <errbound/support/error.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ccd::peers {

enum class outcome {
    same,          ///< the same mesh, or both refuse
    we_refuse,     ///< what the peer takes
    peer_differs,  ///< refuses what we take, or takes it for another mesh
};

/// Why readers may differ on a text.
struct difference {
    outcome when;
    const char* reason;
    bool (*holds)(std::string_view text);
    std::string_view example;  ///< on which they differ for this reason alone
};

/// What a peer does not know of a format, in words that it knows.
struct rewriting {
    const char* reason;
    std::string (*rewritten)(std::string_view text);
    std::string_view example;  ///< on which they differ unless it is rewritten so
};

/// Whether a mesh is one that a reader may return: what peers leave unchecked.
inline bool is_sound(const mesh& m) {
    const auto finite = [](const point<double>& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    const auto sound = [&m](const auto& element) {
        return std::ranges::all_of(element, [&m](vertex_index i) { return i < m.vertices.size(); });
    };
    return std::ranges::all_of(m.vertices, finite) && std::ranges::all_of(m.faces, sound) &&
           std::ranges::all_of(m.edges, sound);
}

/// The mesh that one of our readers takes the text for, if it takes it.
template <class Parse>
std::optional<mesh> read_by(const Parse& parse, std::string_view text) {
    try {
        return parse(text, "peers", io::mesh_options());
    } catch (const errbound::support::file_error&) {
        return std::nullopt;
    }
}

/// Whether the outcome for a text, and what the peer was given for it, needs no explanation or a
/// difference is one.
inline bool is_explained(std::span<const difference> differences, outcome found,
                         std::string_view text, std::string_view given) {
    return found == outcome::same || std::ranges::any_of(differences, [&](const difference& d) {
               return d.when == found && (d.holds(text) || d.holds(given));
           });
}

inline std::string rewritten(std::span<const rewriting> rewritings, std::string_view text) {
    std::string result(text);
    for (const rewriting& r : rewritings) result = r.rewritten(result);
    return result;
}

}  // namespace ccd::peers
