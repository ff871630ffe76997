// State of threads, checked memory and the operations of PTX, for code that translate.py writes.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace ptx {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using s8 = std::int8_t;
using s16 = std::int16_t;
using s32 = std::int32_t;
using s64 = std::int64_t;
using f32 = float;
using f64 = double;

struct lane;
using resolver = void* (*)(lane&, const char* function);

/// Bits of the kind of an access. Strong accesses do not race with each other: atomic and relaxed
/// ones, and volatile ones of global memory.
enum access : u32 { reads = 1, writes = 2, strong = 4, is_volatile = 8 };
/// Checks an access to a state space, and returns its address on the host.
using checked = char* (*)(lane&, u64 address, u32 bytes, u32 access, int line);

/// A block of threads. Times are those of advance_time() in device.hpp.
struct thread_block {
    u32 ntid[3], nctaid[3], ctaid[3];
    char* shared;
    u32 shared_bytes;
    int fill;  ///< the byte that fresh frames hold
    char* parameters;
    checked global_at, shared_at, local_at, generic_at;
    u32 launched, started, met;  ///< when the grid began, the block began, its threads met
    bool any_true;               ///< the result of the barrier's reduction
    const void* module;
    resolver resolve;
};

/// A thread. Its stack frames lie in [stack, stack_end); `frame` is the kernel's or function's own.
struct lane {
    int next;
    u32 id, tid[3], thread;
    u32 known[32];  ///< of each other lane, the time of the last access that is ordered before
    u64 frame, stack, stack_end, stack_limit;
    thread_block* block;
};
constexpr int exited = std::numeric_limits<int>::max();

struct warp {
    lane lanes[32];
    char* registers;
    u32 existing;
};
template <class R>
R& registers_of(warp& w, u32 k) {
    return reinterpret_cast<R*>(w.registers)[k];
}

/// `plain` and `active` run for the lanes that are there; the others wait for the lanes of a mask
/// or for all threads. `sync` is an operation of `warp` that orders accesses to memory.
enum class block_kind { plain, active, warp, sync, barrier };
struct block {
    void (*run)(warp&, u32 lanes);
    block_kind kind;
    u32 (*key)(warp&, u32 lane);   ///< the mask of lanes or the barrier's number
    u32 (*test)(warp&, u32 lane);  ///< the predicate of a barrier that reduces
    u32 instructions;
    int line;
    const char* text;
};
struct parameter {
    u32 offset, bytes;
};
struct kernel {
    const char* name;
    const block* blocks;
    int block_count;
    u32 register_bytes, frame_bytes, shared_bytes, parameter_bytes;
    const parameter* parameters;
    int parameter_count;
    u32 max_threads;
};
struct variable {
    const char* name;
    u64 bytes;
    const unsigned char* initial;  ///< null: zeros
    u64* address;
};

/// Thrown by code that a device would stop, or should.
struct fault {
    const char* what;
    u64 address;
    u32 bytes;
    int line;
    const lane* thread;
};
[[noreturn, gnu::noinline, gnu::cold]] inline void fail(const lane& l, const char* what,
                                                        u64 address, u32 bytes, int line) {
    throw fault{what, address, bytes, line, &l};
}

/// Sets a pointer to a function of the module, which is compiled on first use.
template <class F>
void resolve(lane& l, F*& function, const char* name) {
    if (function == nullptr) function = reinterpret_cast<F*>(l.block->resolve(l, name));
}

template <class F>
void for_lanes(u32 lanes, F f) {
    for (; lanes != 0; lanes &= lanes - 1) f(static_cast<u32>(std::countr_zero(lanes)));
}

template <class T>
T load(const char* p) {
    T x;
    std::memcpy(&x, p, sizeof x);
    return x;
}
template <class T>
void store(char* p, T x) {
    std::memcpy(p, &x, sizeof x);
}

/// The frame of a function, filled with the block's fill byte.
class frame_scope {
  public:
    frame_scope(lane& l, u32 bytes, int line) : lane_(l), frame_(l.frame), end_(l.stack_end) {
        l.frame = l.stack_end;
        l.stack_end += (bytes + 15) & ~u64(15);
        if (l.stack_end > l.stack_limit) fail(l, "stack overflow", l.frame, bytes, line);
        std::memset(reinterpret_cast<char*>(l.frame), l.block->fill, bytes);
    }
    ~frame_scope() { lane_.frame = frame_, lane_.stack_end = end_; }

  private:
    lane& lane_;
    u64 frame_, end_;
};

// Registers have a width, instructions a type: values are reinterpreted, cut off or extended.
template <class T, class R>
T as(R x) {
    if constexpr (std::is_same_v<T, R> || std::is_same_v<R, bool>)
        return static_cast<T>(x);
    else if constexpr (sizeof(T) == sizeof(R))
        return std::bit_cast<T>(x);
    else {
        static_assert(std::is_integral_v<T> && std::is_integral_v<R> && sizeof(T) < sizeof(R));
        return static_cast<T>(x);
    }
}
template <class R, class T>
void set(R& to, T x) {
    if constexpr (std::is_same_v<T, R> || sizeof(T) < sizeof(R)) {
        static_assert(std::is_same_v<T, R> || (std::is_integral_v<T> && std::is_integral_v<R>));
        to = static_cast<R>(x);
    } else {
        to = as<R>(x);
    }
}

template <class T>
T add_carry(T a, T b, bool in, bool& out) {
    T sum, result;
    const bool first = __builtin_add_overflow(a, b, &sum);
    out = __builtin_add_overflow(sum, static_cast<T>(in), &result) || first;
    return result;
}
template <class T>
T subtract_borrow(T a, T b, bool in, bool& out) {
    T difference, result;
    const bool first = __builtin_sub_overflow(a, b, &difference);
    out = __builtin_sub_overflow(difference, static_cast<T>(in), &result) || first;
    return result;
}
template <class T>
T multiply_high(T a, T b) {
    using wide = std::conditional_t<std::is_signed_v<T>, __int128, unsigned __int128>;
    return static_cast<T>((static_cast<wide>(a) * static_cast<wide>(b)) >> (8 * sizeof(T)));
}
template <class T>
T divide(T a, T b) {
    if (b == 0) return static_cast<T>(-1);  // PTX leaves the value unspecified
    if constexpr (std::is_signed_v<T>)
        if (b == -1) return static_cast<T>(-static_cast<std::make_unsigned_t<T>>(a));
    return static_cast<T>(a / b);
}
template <class T>
T remainder(T a, T b) {
    if (b == 0) return a;  // PTX leaves the value unspecified
    if constexpr (std::is_signed_v<T>)
        if (b == -1) return 0;
    return static_cast<T>(a % b);
}
template <class T>
T shift_left(T a, u32 n) {
    return n < 8 * sizeof(T) ? static_cast<T>(a << n) : T(0);
}
template <class T>
T shift_right(T a, u32 n) {
    return n < 8 * sizeof(T) ? static_cast<T>(a >> n) : static_cast<T>(a < 0 ? -1 : 0);
}
template <class T>
T reverse(T a) {
    T result = 0;
    for (u32 i = 0; i < 8 * sizeof(T); ++i) result = static_cast<T>(result << 1 | (a >> i & 1));
    return result;
}
/// b, with bits of a from `position` on.
template <class T>
T insert(T a, T b, u32 position, u32 bits) {
    for (u32 i = 0; i < (bits & 255) && i + (position & 255) < 8 * sizeof(T); ++i) {
        const T bit = T(1) << (i + (position & 255));
        b = (i < 8 * sizeof(T) && (a >> i & 1)) ? b | bit : b & ~bit;
    }
    return b;
}
inline u32 bit_mask(u32 position, u32 bits) {
    return shift_left(bits < 32 ? (1u << bits) - 1 : ~0u, position);
}
inline u32 permute(u32 a, u32 b, u32 selectors) {
    const u64 bytes = u64(b) << 32 | a;
    u32 result = 0;
    for (u32 i = 0; i < 4; ++i) {
        const u32 selector = selectors >> (4 * i) & 15;
        const u32 byte = bytes >> (8 * (selector & 7)) & 255;
        result |= (selector & 8 ? (byte & 128 ? 255 : 0) : byte) << (8 * i);
    }
    return result;
}

template <class T>
T float_min(T a, T b) {
    if (std::isnan(a)) return b;
    if (a == b) return std::signbit(a) ? a : b;
    return b < a ? b : a;
}
template <class T>
T float_max(T a, T b) {
    if (std::isnan(a)) return b;
    if (a == b) return std::signbit(a) ? b : a;
    return b > a ? b : a;
}
/// Rounds toward zero and saturates.
template <class I, class F>
I to_integer(F x) {
    using limits = std::numeric_limits<I>;
    if (std::isnan(x))
        return sizeof(F) == 8 || sizeof(I) == 8 ? I(I(1) << (8 * sizeof(I) - 1)) : I(0);
    const F end = std::ldexp(F(1), limits::digits);
    if (x >= end) return limits::max();
    if (x <= (limits::is_signed ? -end : F(-1))) return limits::min();
    return static_cast<I>(x);
}

/// The lane that a shuffle reads, and whether that lies in the range that `c` allows.
struct shuffled {
    u32 lane;
    bool in_range;
};
inline shuffled shuffle(u32 lane, int from, u32 c, bool up) {
    const int end = static_cast<int>((lane & c >> 8 & 31) | (c & ~(c >> 8) & 31));
    const bool in_range = up ? from >= end : from <= end;
    return {in_range ? static_cast<u32>(from) : lane, in_range};
}

}  // namespace ptx
