#include "ccd/io/body_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <errbound/support/error.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "ccd/io/text.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;
using nlohmann::json;
namespace fs = std::filesystem;

/// Parses a document in which no object repeats a member.
json parsed(const fs::path& path) {
    const std::string name = path.string(), text = errbound::support::read_whole(path);
    std::vector<std::set<std::string>> members;  // of the open objects
    const auto check = [&](int depth, json::parse_event_t event, json& value) {
        constexpr int deepest = 8;
        if (depth > deepest)
            throw file_error(name + ": depth is " + std::to_string(depth) +
                             "; expected a scene of bodies");
        if (event == json::parse_event_t::object_start) members.emplace_back();
        if (event == json::parse_event_t::object_end) members.pop_back();
        if (event == json::parse_event_t::key &&
            !members.back().insert(value.get_ref<const std::string&>()).second)
            throw file_error(name + ": member " + excerpt(value.get_ref<const std::string&>()) +
                             " is repeated; expected it once in an object");
        return true;
    };
    try {
        return json::parse(without_byte_order_mark(text, name), check);
    } catch (const json::parse_error& error) {
        const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(
                                            std::max<std::size_t>(error.byte, 1) - 1, text.size()));
        fail_at(name, static_cast<std::size_t>(std::count(text.begin(), end, '\n')) + 1,
                "text is not JSON; expected a scene of bodies");
    } catch (const json::out_of_range&) {
        throw file_error(name + ": a number is out of range; expected finite numbers");
    }
}

class scene_reader {
  public:
    scene_reader(const fs::path& path, const mesh_options& options)
        : path_(path), options_(options) {}

    body_scene read() {
        const json document = parsed(path_);
        require_members("scene", document, {"bodies", "times", "skip"});
        const json& bodies = member("scene", document, "bodies");
        if (!bodies.is_array() || bodies.empty())
            fail("bodies", bodies, "a list of at least one body");
        for (const json& body : bodies) add_names(body);
        read_times(document, bodies);
        scene_.steps.resize(std::max<std::size_t>(scene_.times.size(), 1) - 1);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            add_mesh(b, bodies[b]);
            add_motions(b, bodies[b]);
        }
        if (document.contains("skip")) read_skipped(document["skip"]);
        if (scene_.times.size() < 2)
            fail("number of frames is " + std::to_string(scene_.times.size()) +
                 "; expected at least 2, by 'times' or by a body's 'poses' or 'matrices'");
        return std::move(scene_);
    }

  private:
    [[noreturn]] void fail(const std::string& subject) const {
        throw file_error(path_.string() + ": " + subject);
    }
    [[noreturn]] void fail(const std::string& subject, const json& found,
                           const std::string& expected) const {
        fail(subject + " is " + excerpt(found.dump(-1, ' ', true, json::error_handler_t::replace)) +
             "; expected " + expected);
    }

    void require_members(const std::string& subject, const json& object,
                         std::initializer_list<std::string_view> names) const {
        if (!object.is_object()) fail(subject, object, "an object");
        for (const auto& [name, value] : object.items())
            if (std::ranges::find(names, name) == names.end()) {
                std::string list;
                for (const std::string_view known : names)
                    list.append(list.empty() ? "" : ", ").append(known);
                fail(subject + ": member " + excerpt(name) + " is unknown; expected one of " +
                     list);
            }
    }
    const json& member(const std::string& subject, const json& object, const char* name) const {
        if (!object.contains(name)) fail(subject + ": member '" + name + "' is missing");
        return object[name];
    }
    std::string text_in(const std::string& subject, const json& value) const {
        const auto* text = value.get_ptr<const std::string*>();
        if (!text || text->empty() || std::ranges::any_of(*text, is_control))
            fail(subject, value, "a text, not empty, without control characters");
        return *text;
    }
    template <std::size_t N>
    std::array<double, N> numbers_in(const std::string& subject, const json& list) const {
        const std::string expected = std::to_string(N) + " numbers";
        if (!list.is_array() || list.size() != N) fail(subject, list, expected);
        std::array<double, N> numbers;
        for (std::size_t i = 0; i < N; ++i) {
            if (!list[i].is_number()) fail(subject, list, expected);
            numbers[i] = list[i].get<double>();
        }
        return numbers;
    }

    void add_names(const json& body) {
        const std::size_t index = scene_.names.size();
        std::string subject = "body " + std::to_string(index);
        require_members(subject, body, {"name", "mesh", "group", "centre", "poses", "matrices"});
        const std::string name = body.contains("name") ? text_in("name of " + subject, body["name"])
                                                       : std::to_string(index);
        if (std::ranges::find(scene_.names, name) != scene_.names.end())
            fail("name of " + subject + " is " + excerpt(name) +
                 ", as of another body; expected different names");
        scene_.names.push_back(name);
        scene_.groups.push_back(
            body.contains("group") ? text_in("group of " + subject, body["group"]) : std::string());
    }
    std::string said(std::size_t body) const { return "body " + excerpt(scene_.names[body]); }

    /// Without times, the bodies' poses determine the number of frames, which are 1 apart.
    void read_times(const json& document, const json& bodies) {
        std::size_t frames = 0;
        for (std::size_t b = 0; b < bodies.size(); ++b)
            for (const char* name : {"poses", "matrices"})
                if (bodies[b].contains(name)) {
                    const json& list = bodies[b][name];
                    if (!list.is_array()) fail(name + (" of " + said(b)), list, "a list");
                    frames = std::max(frames, list.size());
                }
        if (!document.contains("times")) {
            for (std::size_t i = 0; i < frames; ++i) scene_.times.push_back(static_cast<double>(i));
        } else {
            const json& times = document["times"];
            if (!times.is_array() || times.size() < 2)
                fail("times", times, "a list of at least 2 numbers");
            for (const json& time : times) {
                if (!time.is_number()) fail("times", times, "a list of at least 2 numbers");
                const auto t = time.get<double>();
                if (!scene_.times.empty() && !(scene_.times.back() < t))
                    fail("time " + std::to_string(scene_.times.size()), time,
                         "more than the time before");
                scene_.times.push_back(t);
            }
        }
    }

    void add_mesh(std::size_t b, const json& body) {
        const std::string subject = said(b);
        const fs::path mesh = text_in("mesh of " + subject, member(subject, body, "mesh"));
        scene_.mesh_files.push_back(path_.parent_path() / mesh);
        scene_.meshes.push_back(read_mesh(scene_.mesh_files.back(), options_));
    }

    /// Adds the motions between `count` poses; a single one is that of all frames. motion(i, j)
    /// leads from pose i to pose j.
    template <class Motion>
    void add_steps(std::size_t b, const char* member, std::size_t count, const Motion& motion) {
        const std::size_t frames = scene_.times.size();
        if (count != frames && count != 1)
            fail("number of " + std::string(member) + " of " + said(b) + " is " +
                 std::to_string(count) + "; expected " + std::to_string(frames) +
                 ", one for each frame, or 1");
        for (std::size_t step = 0; step + 1 < frames; ++step) {
            const body_motion added = count == 1 ? motion(0, 0) : motion(step, step + 1);
            if (const std::string fault = fault_of(added); !fault.empty())
                fail(said(b) + ", step " + std::to_string(step) + ": " + fault);
            scene_.steps[step].push_back(added);
        }
    }

    void add_motions(std::size_t b, const json& body) {
        if (body.contains("poses") && body.contains("matrices"))
            fail(said(b) + " has 'poses' and 'matrices'; expected at most one of them");
        if (body.contains("centre") && !body.contains("poses"))
            fail("centre of " + said(b) + " is given without poses; expected both or none");
        if (body.contains("poses"))
            add_rigid(b, body);
        else if (body.contains("matrices"))
            add_affine(b, body["matrices"]);
        else
            for (auto& step : scene_.steps) step.push_back(resting{});
    }

    void add_rigid(std::size_t b, const json& body) {
        point<double> centre;
        if (body.contains("centre")) {
            const auto c = numbers_in<3>("centre of " + said(b), body["centre"]);
            centre = {c[0], c[1], c[2]};
        }
        std::vector<pose> poses;
        for (const json& one : body["poses"]) {
            const auto p =
                numbers_in<7>("pose " + std::to_string(poses.size()) + " of " + said(b), one);
            poses.push_back({{p[3], p[4], p[5], p[6]}, {p[0], p[1], p[2]}});
        }
        add_steps(b, "poses", poses.size(), [&](std::size_t i, std::size_t j) {
            rigid_motion motion = shorter_arc(poses[i], poses[j]);
            motion.centre = centre;
            return motion;
        });
    }

    void add_affine(std::size_t b, const json& matrices) {
        std::vector<std::pair<matrix3, point<double>>> poses;
        for (const json& one : matrices) {
            const std::string subject = "matrix " + std::to_string(poses.size()) + " of " + said(b);
            if (!one.is_array() || one.size() != 4) fail(subject, one, "4 rows of 4 numbers");
            auto& [a, p] = poses.emplace_back();
            std::array<double, 3> shift;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto row =
                    numbers_in<4>("row " + std::to_string(i) + " of " + subject, one[i]);
                std::copy_n(row.begin(), 3, a[i].begin());
                shift[i] = row[3];
            }
            if (numbers_in<4>("row 3 of " + subject, one[3]) != std::array<double, 4>{0, 0, 0, 1})
                fail("row 3 of " + subject, one[3], "[0, 0, 0, 1]");
            p = {shift[0], shift[1], shift[2]};
        }
        add_steps(b, "matrices", poses.size(), [&](std::size_t i, std::size_t j) {
            return affine_motion{poses[i].first, poses[j].first, poses[i].second, poses[j].second};
        });
    }

    void read_skipped(const json& list) {
        const std::string expected = "a list of pairs of different bodies' names";
        if (!list.is_array()) fail("skip", list, expected);
        for (const json& pair : list) {
            if (!pair.is_array() || pair.size() != 2) fail("skip", list, expected);
            std::array<std::size_t, 2> bodies;
            for (std::size_t i = 0; i < 2; ++i) {
                const auto found =
                    std::ranges::find(scene_.names, text_in("name in skip", pair[i]));
                if (found == scene_.names.end())
                    fail("name in skip", pair[i], "the name of a body");
                bodies[i] = static_cast<std::size_t>(found - scene_.names.begin());
            }
            if (bodies[0] == bodies[1]) fail("skip", pair, "two different bodies");
            scene_.skipped.emplace_back(std::min(bodies[0], bodies[1]),
                                        std::max(bodies[0], bodies[1]));
        }
        std::ranges::sort(scene_.skipped);
    }

    fs::path path_;
    mesh_options options_;
    body_scene scene_;
};

}  // namespace

bool body_scene::may_touch(std::size_t a, std::size_t b) const {
    return (groups[a].empty() || groups[a] != groups[b]) &&
           !std::ranges::binary_search(skipped, std::pair(a, b));
}

body_scene read_body_scene(const fs::path& path, const mesh_options& options) {
    return scene_reader(path, options).read();
}

}  // namespace ccd::io
