// The PLY writer.
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <cstdint>
#include <type_traits>

namespace ccd::io {
namespace {

template <class Value>
void append(std::string& text, const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header_of(const mesh& frame) {
    std::string text = "ply\nformat binary_";
    text += std::endian::native == std::endian::little ? "little" : "big";
    text += "_endian 1.0\nelement vertex " + std::to_string(frame.vertices.size());
    for (const char axis : {'x', 'y', 'z'}) (text += "\nproperty double ") += axis;
    text += "\nelement face " + std::to_string(frame.faces.size());
    text += "\nproperty list uchar uint vertex_indices";
    if (!frame.edges.empty())
        text += "\nelement edge " + std::to_string(frame.edges.size()) +
                "\nproperty uint vertex1\nproperty uint vertex2";
    return text + "\nend_header\n";
}

}  // namespace

std::string ply_of(const mesh& frame) {
    std::string text = header_of(frame);
    for (const point<double>& p : frame.vertices) append(text, p);
    for (const face& f : frame.faces) {
        append(text, std::uint8_t(f.size()));
        append(text, f);
    }
    for (const edge& e : frame.edges) append(text, e);
    return text;
}

}  // namespace ccd::io
