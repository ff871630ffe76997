// Candidates of one step: pairs that share no vertex and whose swept boxes touch.
//
// They are never stored as a whole: each thread fills a block and hands it to the consumer.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>

#include <array>
#include <ccd/batch.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "ccd/step/box_tree.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/step_frames.hpp"

namespace ccd {

/// One block of candidates for each thread.
template <class Candidate, class Consume>
class candidate_blocks {
  public:
    static constexpr std::size_t block_size = 2048;

    class block {
      public:
        explicit block(const Consume& consume) : consume_(&consume) {}

        /// Adds the candidate if `is_one`.
        void add(const Candidate& c, bool is_one) {
            candidates_[size_] = c;  // unconditionally: a branch would often be mispredicted
            size_ += is_one;
            if (size_ == block_size) flush();
        }
        void flush() {
            if (size_ > 0) (*consume_)(std::span<const Candidate>(candidates_.data(), size_));
            count_ += size_;
            size_ = 0;
        }
        std::size_t count() const { return count_; }

      private:
        const Consume* consume_;
        std::size_t size_ = 0, count_ = 0;
        std::array<Candidate, block_size> candidates_;
    };

    explicit candidate_blocks(const Consume& consume)
        : blocks_([&consume] { return block(consume); }) {}

    block& local() { return blocks_.local(); }

    /// Hands out what is left. Returns the number of candidates.
    std::size_t finish() {
        tbb::parallel_for_each(blocks_, [](block& b) { b.flush(); });
        return std::transform_reduce(blocks_.begin(), blocks_.end(), std::size_t(0), std::plus<>(),
                                     [](const block& b) { return b.count(); });
    }

  private:
    tbb::enumerable_thread_specific<block> blocks_;
};

template <class Real, class Consume>
std::size_t vertex_face_candidates_by(const step_frames& frames, std::span<const face> mesh_faces,
                                      std::size_t vertex_count, const Consume& consume) {
    std::vector<std::array<index, 1>> vertices(vertex_count);
    for (std::size_t i = 0; i < vertex_count; ++i) vertices[i] = {static_cast<index>(i)};
    vertices = frames.along_curve<Real>(std::span<const std::array<index, 1>>(vertices));
    const std::vector<face> faces = frames.along_curve<Real>(mesh_faces);
    const box_tree<Real> vertex_tree(
        vertices.size(), [&](std::size_t i) { return frames.swept_box<Real>(vertices[i]); });
    const box_tree<Real> face_tree(faces.size(),
                                   [&](std::size_t i) { return frames.swept_box<Real>(faces[i]); });

    candidate_blocks<vertex_face_pair, Consume> blocks(consume);
    for_each_touching(
        vertex_tree, face_tree, [&]() -> auto& { return blocks.local(); },
        [&](auto& block, std::size_t i, std::size_t j, bool certain) {
            const std::array<index, 1>& v = vertices[i];
            const face& f = faces[j];
            const bool apart = !share_vertex(v, f);
            block.add(candidate_of(v, f), certain ? apart : apart && frames.touch(v, f));
        });
    return blocks.finish();
}

template <class Real, class Consume>
std::size_t edge_edge_candidates_by(const step_frames& frames, std::vector<edge> edges,
                                    const Consume& consume) {
    edges = frames.along_curve<Real>(std::span<const edge>(edges));
    const box_tree<Real> tree(edges.size(),
                              [&](std::size_t i) { return frames.swept_box<Real>(edges[i]); });
    candidate_blocks<edge_edge_pair, Consume> blocks(consume);
    for_each_touching(
        tree, tree, [&]() -> auto& { return blocks.local(); },
        [&](auto& block, std::size_t i, std::size_t j, bool certain) {
            const edge &a = edges[i], &b = edges[j];
            const bool apart = !share_vertex(a, b);
            block.add(candidate_of(a, b), certain ? apart : apart && frames.touch(a, b));
        });
    return blocks.finish();
}

/// Calls consume(block) with all vertex/face candidates, in blocks (spans of vertex_face_pair)
/// of up to 2048, from several threads at once; it must not wait for other tasks of its arena. The
/// vertices of a face come in the mesh's order. Returns the number of candidates. Working memory:
/// about 40 bytes a face and 32 a vertex, twice as much where floats do not do, and 32 KB a thread.
template <class Consume>
std::size_t vertex_face_candidates(const step_frames& frames, std::span<const face> faces,
                                   std::size_t vertex_count, const Consume& consume) {
    return frames.need_doubles(faces)
               ? vertex_face_candidates_by<double>(frames, faces, vertex_count, consume)
               : vertex_face_candidates_by<float>(frames, faces, vertex_count, consume);
}

/// The same for the edge/edge candidates, in blocks of edge_edge_pair: each edge as given, the
/// lesser edge first. `edges` must be unique; they are released when no longer needed. Working
/// memory: about 44 bytes an edge, twice as much where floats do not do, and 32 KB a thread.
template <class Consume>
std::size_t edge_edge_candidates(const step_frames& frames, std::vector<edge> edges,
                                 const Consume& consume) {
    return frames.need_doubles(std::span<const edge>(edges))
               ? edge_edge_candidates_by<double>(frames, std::move(edges), consume)
               : edge_edge_candidates_by<float>(frames, std::move(edges), consume);
}

}  // namespace ccd
