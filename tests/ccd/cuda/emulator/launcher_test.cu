// Compares device_launcher, CUB included, with the host: loops, queues, warps, scans, reductions,
// sorting, memory.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <random>
#include <vector>

#include "ccd/cuda/cub.cuh"

namespace {

using namespace ccd::cuda::detail;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
template <class T>
using buffer = device_launcher::buffer<T>;

struct fill {
    u32* to;
    constexpr void operator()(u32 i) const { to[i] = i * 2654435761u; }
};
struct push_some {
    queue q;
    constexpr void operator()(u32 i) const {
        if (i % 5 == 0 || i % 7 == 3) q.push(i);
    }
};
struct push_next_of_odd {
    queue q;
    constexpr void operator()(u32 i) const {
        if (i & 1) q.push(i + 1);
    }
};
/// Lane k of packet p has the bits of p + k, and writes its number once for each bit.
struct append_bits {
    u32 *ballots, *to;
    u64* size;
    constexpr void operator()(u32 packet) const {
        warp::per_lane<u32> masks;
        warp::per_lane<u64> places;
        warp::each([&](u32 lane) { masks[lane] = packet + lane; });
        const u32 ballot = warp::ballot([&](u32 lane) { return masks[lane] % 3 == 0; });
        warp::each([&](u32 lane) {
            if (lane == 0) ballots[packet] = ballot;
        });
        warp::append(size, masks, places);
        warp::each([&](u32 lane) {
            for (u32 k = 0; k < warp::count(masks[lane]); ++k)
                to[places[lane] + k] = packet * warp::lanes + lane;
        });
    }
};
struct lower {
    shared_time t;
    const double* of;
    constexpr void operator()(u32 i) const { t.lower(of[i]); }
};
struct value_of {
    const u64* v;
    constexpr u64 operator()(u32 i) const { return v[i]; }
};
struct larger {
    constexpr u64 operator()(u64 a, u64 b) const { return a < b ? b : a; }
};

std::mt19937_64 random_bits(7);
device_launcher launcher(nullptr);
bool all_right = true;

void expect(bool right, const char* what, std::size_t n) {
    if (!right) std::printf("%s of %zu differs\n", what, n), all_right = false;
}
template <class T>
std::vector<T> read(const T* p, std::size_t n) {
    std::vector<T> host(n);
    launcher.read(p, n, host.data());
    return host;
}
template <class T>
void copy(buffer<T>& to, const std::vector<T>& host) {
    to.resize(launcher, host.size());
    launcher.write(to.data(), host.size(), host.data());
}

void loops_and_queues(std::size_t n) {
    buffer<u32> filled, first, second, sizes;
    filled.resize(launcher, n), first.resize(launcher, n + 1), second.resize(launcher, n + 1);
    copy(sizes, std::vector<u32>{0, 0});
    launcher.for_each(n, fill{filled.data()});
    const queue to_first{first.data(), sizes.data()}, to_second{second.data(), sizes.data() + 1};
    launcher.for_each(n, push_some{to_first});
    launcher.for_each_queued(to_first, push_next_of_odd{to_second});
    std::vector<u32> expected_filled(n), expected_first, expected_second;
    for (u32 i = 0; i < n; ++i) {
        expected_filled[i] = i * 2654435761u;
        if (i % 5 != 0 && i % 7 != 3) continue;
        expected_first.push_back(i);
        if (i & 1) expected_second.push_back(i + 1);
    }
    const auto size = read(sizes.data(), 2);
    auto found_first = read(first.data(), size[0]), found_second = read(second.data(), size[1]);
    std::ranges::sort(found_first), std::ranges::sort(found_second);
    expect(read(filled.data(), n) == expected_filled, "for_each", n);
    expect(found_first == expected_first, "push", n);
    expect(found_second == expected_second, "for_each_queued", n);
}

void packets(std::size_t n) {
    std::vector<u32> expected_ballots(n), expected;
    for (u32 i = 0; i < n * warp::lanes; ++i) {
        const u32 mask = i / warp::lanes + i % warp::lanes;
        expected_ballots[i / warp::lanes] |= u32{mask % 3 == 0} << i % warp::lanes;
        expected.insert(expected.end(), std::popcount(mask), i);
    }
    buffer<u32> ballots, items;
    buffer<u64> size;
    ballots.resize(launcher, n), items.resize(launcher, expected.size());
    copy(size, std::vector<u64>{0});
    launcher.for_each_packet(n, append_bits{ballots.data(), items.data(), size.data()});
    auto found = read(items.data(), expected.size());
    const auto end = std::ranges::adjacent_find(
        found, [](u32 a, u32 b) { return a / warp::lanes == b / warp::lanes && a > b; });
    expect(end == found.end(), "order of lanes", n);
    std::ranges::sort(found);
    expect(found == expected && read(size.data(), 1)[0] == expected.size(), "append", n);
    expect(read(ballots.data(), n) == expected_ballots, "ballot", n);
}

void scans_and_reductions(std::size_t n) {
    std::vector<u64> values(n), sums(n + 1);
    for (u64& v : values) v = random_bits() >> 31;  // sums exceed 2^32
    for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + values[i];
    buffer<u64> of, wide, most;
    buffer<u32> narrow;
    copy(of, values);
    wide.resize(launcher, n + 1), narrow.resize(launcher, n + 1), most.resize(launcher, 1);
    launcher.exclusive_scan(value_of{of.data()}, wide.data(), n);
    launcher.exclusive_scan(value_of{of.data()}, narrow.data(), n);
    launcher.reduce(n, value_of{of.data()}, larger{}, u64(5), most.data());
    expect(read(wide.data(), n + 1) == sums, "exclusive_scan", n);
    expect(read(narrow.data(), n + 1) == std::vector<u32>(sums.begin(), sums.end()),
           "32-bit exclusive_scan", n);
    values.push_back(5);
    expect(read(most.data(), 1)[0] == std::ranges::max(values), "reduce", n);
}

void sorting(std::size_t n, u64 different_keys) {
    std::vector<u32> keys(n), values(n);
    for (u32 i = 0; i < n; ++i)
        keys[i] = static_cast<u32>(random_bits() % different_keys), values[i] = i;
    buffer<u32> k, v;
    copy(k, keys), copy(v, values);
    launcher.sort(k.data(), v.data(), n);
    host_launcher{}.sort(keys.data(), values.data(), n);
    expect(read(k.data(), n) == keys && read(v.data(), n) == values, "sort", n);
}

void least_time(std::size_t n) {
    std::vector<double> times(n);
    for (double& t : times) t = double(random_bits() % 1000000) / 1e6;
    buffer<double> of, least;
    copy(of, times);
    least.resize(launcher, 1);
    launcher.set(least.data(), 0.75);
    launcher.for_each(n, lower{shared_time(least.data()), of.data()});
    times.push_back(0.75);
    expect(read(least.data(), 1)[0] == std::ranges::min(times), "shared_time", n);
}

}  // namespace

int main() {
    for (const std::size_t n : {0, 1, 31, 32, 33, 128, 129, 1000, 2048, 3000, 9999, 100001}) {
        loops_and_queues(n);
        scans_and_reductions(n);
        for (const u64 different_keys : {u64(1), u64(3), u64(1) << 32}) sorting(n, different_keys);
        least_time(n);
        packets(n / 30);
    }
    if (!launcher.ok()) std::printf("%s\n", launcher.result().error.c_str()), all_right = false;
    std::printf("%s\n", all_right ? "the launcher agrees with the host" : "FAILED");
    return all_right ? 0 : 1;
}
