// The warps of a block advance in turn until each waits at a barrier. Within a warp, the lanes with
// the smallest block index advance, so that lanes that diverged meet again where the compiler
// expects it.
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <random>

#include "tests/ccd/cuda/emulator/device.hpp"

namespace ptx {
namespace {

constexpr u32 stack_bytes = 96 * 1024;

void* resolve_in_module(lane& l, const char* function) {
    return static_cast<module*>(const_cast<void*>(l.block->module))->find_function(function);
}

/// The work of all launches of a kernel, without that of the functions that it calls.
struct work {
    u64 launches = 0, of_warps = 0, of_lanes = 0;
};
class work_table {
  public:
    work& of(const launch& l) { return kernels_[l.code->name]; }
    ~work_table() {
        if (setting("PTXEMU_COUNT") == 0) return;
        for (const auto& [name, w] : kernels_)
            std::fprintf(stderr,
                         "%llu launches, %llu warp instructions, SIMT efficiency %.2f: %s\n",
                         static_cast<unsigned long long>(w.launches),
                         static_cast<unsigned long long>(w.of_warps),
                         double(w.of_lanes) / (32 * double(w.of_warps)), name.c_str());
    }

  private:
    std::map<std::string, work> kernels_;
};
work_table executed;

class block_runner {
  public:
    explicit block_runner(launch& l)
        : code_(*l.code),
          work_(executed.of(l)),
          threads_(l.block[0] * l.block[1] * l.block[2]),
          shared_bytes_(code_.shared_bytes + l.dynamic_shared_bytes),
          warps_((threads_ + 31) / 32),
          registers_(warps_.size() * 32 * code_.register_bytes / 16 + 4),
          stacks_(std::size_t(threads_) * stack_bytes / 16) {
        std::copy_n(l.block, 3, block_.ntid);
        std::copy_n(l.grid, 3, block_.nctaid);
        block_.fill = fill_byte();
        block_.parameters = l.parameters.data();
        block_.module = l.of;
        block_.resolve = resolve_in_module;
        block_.launched = advance_time();
        ++work_.launches;
    }

    void run(u32 x, u32 y, u32 z) {
        block_.ctaid[0] = x, block_.ctaid[1] = y, block_.ctaid[2] = z;
        block_.started = block_.met = advance_time();
        set_memory(block_, shared_bytes_);
        std::memset(registers_.data(), fill_byte(), registers_.size() * sizeof registers_[0]);
        for (u32 i = 0; i < warps_.size() * 32; ++i) start(i);
        for (;;) {
            bool waiting = false;
            for (warp& w : warps_) waiting |= run_warp(w);
            if (!waiting) return;
            pass_barrier();
        }
    }

  private:
    struct alignas(16) line {
        char bytes[16];
    };

    void start(u32 thread) {
        warp& w = warps_[thread / 32];
        if (thread % 32 == 0) {
            w.registers = reinterpret_cast<char*>(registers_.data()) +
                          std::size_t(thread) * code_.register_bytes;
            w.existing = 0;
        }
        lane& l = w.lanes[thread % 32];
        l = {};
        l.next = exited;
        if (thread >= threads_) return;
        l.next = 0;
        w.existing |= 1u << thread % 32;
        l.id = thread % 32;
        l.thread = thread;
        l.tid[0] = thread % block_.ntid[0];
        l.tid[1] = thread / block_.ntid[0] % block_.ntid[1];
        l.tid[2] = thread / block_.ntid[0] / block_.ntid[1];
        char* const stack =
            reinterpret_cast<char*>(stacks_.data()) + std::size_t(thread) * stack_bytes;
        std::memset(stack, fill_byte(), code_.frame_bytes);
        l.frame = l.stack = reinterpret_cast<u64>(stack);
        l.stack_end = l.stack + (code_.frame_bytes + 15) / 16 * 16;
        l.stack_limit = l.stack + stack_bytes;
        l.block = &block_;
    }

    static u32 lanes_at(const warp& w, int next) {
        u32 lanes = 0;
        for (u32 i = 0; i < 32; ++i) lanes |= u32(w.lanes[i].next == next) << i;
        return lanes;
    }

    /// Runs until all lanes have exited or wait at a barrier. True if some wait.
    bool run_warp(warp& w) {
        for (;;) {
            const u32 running = ~lanes_at(w, exited);
            if (running == 0) return false;
            bool advanced = false, at_barriers = true;
            for (int at = -1; !advanced;) {
                int next = exited;
                for (const lane& l : w.lanes)
                    if (l.next > at) next = std::min(next, l.next);
                if (next == exited) break;
                at = next;
                advanced = advance(w, code_.blocks[at], lanes_at(w, at), running);
                at_barriers = at_barriers && code_.blocks[at].kind == block_kind::barrier;
            }
            if (advanced) continue;
            if (at_barriers) return true;
            const lane& l = w.lanes[std::countr_zero(running)];
            fail(l, "lanes of a warp wait for lanes that never arrive", 0, 0,
                 code_.blocks[l.next].line);
        }
    }

    void run_lanes(warp& w, const block& b, u32 lanes) {
        b.run(w, lanes);
        work_.of_warps += lanes != 0 ? b.instructions : 0;
        work_.of_lanes += b.instructions * u64(std::popcount(lanes));
    }

    /// Runs the block for the present lanes, unless one of them must wait.
    bool advance(warp& w, const block& b, u32 here, u32 running) {
        if (b.kind == block_kind::barrier) return false;
        if (b.kind != block_kind::warp && b.kind != block_kind::sync) {
            run_lanes(w, b, here);
            return true;
        }
        bool advanced = false;
        for_lanes(here, [&](u32 i) {
            if (advanced) return;
            const u32 mask = b.key(w, i) & w.existing;
            if (!(mask >> i & 1))
                fail(w.lanes[i], "the mask of a warp's operation lacks the lane itself", mask, 0,
                     b.line);
            if ((mask & running & ~here) != 0) return;
            for_lanes(mask & running, [&](u32 other) {
                if ((b.key(w, other) & w.existing) != mask)
                    fail(w.lanes[i], "lanes meet with different masks", mask, 0, b.line);
            });
            run_lanes(w, b, mask & running);
            if (b.kind == block_kind::sync) order(w, mask & running);
            advanced = true;
        });
        return advanced;
    }

    /// Orders the accesses of lanes, and all that are ordered before them, before their next ones.
    static void order(warp& w, u32 lanes) {
        u32 known[32] = {};
        for_lanes(lanes, [&](u32 i) {
            for (u32 k = 0; k < 32; ++k) known[k] = std::max(known[k], w.lanes[i].known[k]);
        });
        const u32 time = advance_time();
        for_lanes(lanes, [&](u32 i) { known[i] = time; });
        for_lanes(lanes, [&](u32 i) {
            std::copy_n(known, 32, w.lanes[i].known);
            w.lanes[i].known[i] = 0;
        });
    }

    /// All threads must be at one barrier.
    void pass_barrier() {
        int at = exited;
        for (const warp& w : warps_)
            for (const lane& l : w.lanes) at = std::min(at, l.next);
        const block& b = code_.blocks[at];
        for (const warp& w : warps_)
            for_lanes(w.existing & ~lanes_at(w, at), [&](u32 i) {
                fail(w.lanes[i],
                     w.lanes[i].next == exited ? "a thread has left before others wait at a barrier"
                                               : "threads wait at different barriers",
                     0, 0, b.line);
            });
        block_.met = advance_time();
        block_.any_true = false;
        if (b.test != nullptr)
            for (warp& w : warps_)
                for_lanes(lanes_at(w, at), [&](u32 i) { block_.any_true |= b.test(w, i) != 0; });
        for (warp& w : warps_) run_lanes(w, b, lanes_at(w, at));
    }

    const kernel& code_;
    work& work_;
    u32 threads_, shared_bytes_;
    thread_block block_{};
    std::vector<warp> warps_;
    std::vector<line> registers_, stacks_;
};

/// The order in which blocks run: shuffled with the seed PTXEMU_SHUFFLE, except kernels of CUB,
/// whose blocks wait for blocks of smaller index.
std::vector<u32> block_order(const launch& l, u32 count) {
    static std::mt19937_64 random(static_cast<u64>(setting("PTXEMU_SHUFFLE")));
    std::vector<u32> order(count);
    std::iota(order.begin(), order.end(), 0u);
    if (setting("PTXEMU_SHUFFLE") != 0 && !std::strstr(l.code->name, "3cub"))
        std::shuffle(order.begin(), order.end(), random);
    return order;
}

}  // namespace

std::string run(launch& l) {
    block_runner runner(l);
    try {
        for (const u32 i : block_order(l, l.grid[0] * l.grid[1] * l.grid[2]))
            runner.run(i % l.grid[0], i / l.grid[0] % l.grid[1], i / l.grid[0] / l.grid[1]);
    } catch (const fault& f) {
        char text[200];
        const lane& t = *f.thread;
        std::snprintf(text, sizeof text, "%s: address %llx, %u bytes, block %u, thread %u, ",
                      f.what, static_cast<unsigned long long>(f.address), f.bytes,
                      t.block->ctaid[0], t.tid[0]);
        return text + l.of->file() + ":" + std::to_string(f.line) + ", " + l.code->name;
    }
    return {};
}

}  // namespace ptx
