// The extension module errbound._cuda: queries and steps in device memory. errbound/cuda.py checks
// the arguments, and keeps the arrays at the addresses until a call returns.
#include <cuda_runtime_api.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <ccd/cuda.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "results.hpp"

namespace errbound::python {
namespace {

using address = std::uintptr_t;

void check(cudaError_t error) {
    if (error == cudaSuccess) return;
    (void)cudaGetLastError();
    throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(error));
}
void check(const ccd::cuda::status& found) {
    if (found) return;
    if (found.error.starts_with("CUDA: ")) throw std::runtime_error(found.error);
    throw std::invalid_argument(found.error);
}

/// Makes a device current in its scope. The device is that of an array, so it exists.
class current_device {
  public:
    explicit current_device(int device) {
        (void)cudaGetDevice(&before_);
        (void)cudaSetDevice(device);
    }
    ~current_device() { (void)cudaSetDevice(before_); }

  private:
    int before_ = 0;
};

/// Returns call(), run without the interpreter's lock while the device is current.
template <class Call>
auto on_device(int device, const Call& call) {
    const nb::gil_scoped_release released;
    const current_device current(device);
    return call();
}

/// Memory of the device that is current on construction.
struct memory {
    std::size_t bytes;
    int device = 0;
    std::shared_ptr<void> data;

    explicit memory(std::size_t size) : bytes(size) {
        void* allocated = nullptr;
        check(cudaGetDevice(&device));
        if (bytes > 0) check(cudaMalloc(&allocated, bytes));
        data.reset(allocated, [on = device](void* p) {
            const current_device current(on);
            (void)cudaFree(p);
        });
    }
    /// Queues a copy of items in device memory.
    template <class Item>
    memory(std::span<const Item> items, ccd::cuda::stream stream) : memory(items.size_bytes()) {
        if (bytes == 0) return;
        check(cudaMemcpyAsync(data.get(), items.data(), bytes, cudaMemcpyDeviceToDevice, stream));
    }
    template <class Item>
    Item* items() const {
        return static_cast<Item*>(data.get());
    }
};

/// Memory that arrays in Python own. cudaFree waits for the device, whose work may wait for the
/// interpreter's lock.
struct owned_memory : memory {
    explicit owned_memory(memory&& made) : memory(std::move(made)) {}
    ~owned_memory() {
        const nb::gil_scoped_release released;
        data.reset();
    }
};
nb::object owned(memory&& made) {
    return nb::cast(new owned_memory(std::move(made)), nb::rv_policy::take_ownership);
}

/// Returns a DLPack capsule that keeps the memory. The offset is in bytes, strides are in items.
nb::object capsule_of(nb::handle_t<owned_memory> owner, std::size_t offset,
                      const std::vector<std::size_t>& shape,
                      const std::vector<std::int64_t>& strides, std::uint8_t code,
                      std::uint8_t bits) {
    const auto& all = nb::cast<const owned_memory&>(owner);
    return nb::cast(nb::ndarray<>(all.items<char>() + offset, shape.size(), shape.data(), owner,
                                  strides.data(), {code, bits, 1}, nb::device::cuda::value,
                                  all.device));
}

/// The addresses of x, y and z of vertex 0, and the stride of vertices in numbers.
using frame = std::array<address, 4>;

/// The device, stream, method and positions of a call.
struct device_request {
    int device;
    ccd::cuda::stream stream;
    ccd::method method;
    ccd::cuda::precision precision;
    ccd::cuda::positions at;

    device_request(int on, address queue, const std::string& name, bool float32,
                   const frame& before, const frame& after, bool in_floats, std::size_t vertices)
        : device(on), stream(reinterpret_cast<ccd::cuda::stream>(queue)), method(method_of(name)) {
        precision = float32 ? ccd::cuda::precision::float32 : ccd::cuda::precision::float64;
        const auto frame_of = [](const frame& f) -> ccd::cuda::positions::frame {
            const auto axis = [&](int i) { return reinterpret_cast<const void*>(f[i]); };
            return {{axis(0), axis(1), axis(2)}, f[3]};
        };
        at.before = frame_of(before), at.after = frame_of(after);
        at.in_floats = in_floats, at.vertices = vertices;
    }
};

/// Decided queries, in rows or columns of vertex indices. Construct on the device.
template <class Pair>
struct decided {
    ccd::cuda::candidates<Pair> all;
    memory outcomes, room;
    ccd::cuda::scratch scratch;

    decided(const device_request& of, address data, std::size_t count, bool in_columns)
        : outcomes(count), room(ccd::cuda::scratch_bytes(of.at.vertices, count)) {
        const auto* const a = reinterpret_cast<const ccd::vertex_index*>(data);
        all = in_columns ? all.of_columns(a, a + count, a + 2 * count, a + 3 * count, count)
                         : all.rows(reinterpret_cast<const Pair*>(data), count);
        scratch = {room.data.get(), room.bytes};
        const ccd::cuda::batch_options options{of.method, of.precision, of.stream};
        check(decide_batch(of.at, all, answers(), scratch, options));
        check(finish(of.at, all, answers(), scratch, options));
        check(cudaStreamSynchronize(of.stream));
    }
    ccd::outcome* answers() const { return outcomes.template items<ccd::outcome>(); }
};

template <class Pair>
nb::object decide(const device_request& of, address data, std::size_t count, bool in_columns) {
    return owned(on_device(
        of.device, [&] { return std::move(decided<Pair>(of, data, count, in_columns).outcomes); }));
}

/// Returns the indices of the queries that may collide, and their times.
template <class Pair>
nb::tuple first_times(const device_request& of, address data, std::size_t count, bool in_columns,
                      double t_max) {
    auto [queries, times] = on_device(of.device, [&] {
        const decided<Pair> found(of, data, count, in_columns);
        const memory room((count + 1) * sizeof(ccd::vertex_index));
        auto* const numbers = room.items<ccd::vertex_index>();
        check(select_colliding(found.answers(), count, numbers, count, numbers + count,
                               found.scratch, of.stream));
        ccd::vertex_index k = 0;
        check(cudaMemcpyAsync(&k, numbers + count, sizeof k, cudaMemcpyDeviceToHost, of.stream));
        check(cudaStreamSynchronize(of.stream));
        const memory of_queries(std::span<const ccd::vertex_index>(numbers, k), of.stream);
        const memory of_times(k * sizeof(ccd::first_time));
        const auto colliding = found.all.listed(numbers, k);
        auto* const to = of_times.items<ccd::first_time>();
        check(find_times(of.at, colliding, to, found.scratch, {t_max, of.stream}));
        check(finish_times(of.at, colliding, to, found.scratch, {t_max, of.stream}));
        check(cudaStreamSynchronize(of.stream));
        return std::pair(of_queries, of_times);
    });
    return nb::make_tuple(owned(std::move(queries)), owned(std::move(times)));
}

/// ccd::cuda::mesh_steps. nanobind needs names that differ from those in other extensions.
class device_steps {
  public:
    device_steps(const input<std::uint32_t, -1, 3>& faces, std::size_t vertices)
        : steps_(std::in_place, items_of<ccd::face>(faces), vertices) {}
    ~device_steps() {
        on_device(device_, [&] { steps_.reset(); });
    }

    /// Returns two counts of candidates, the first contact, and a list of the pairs, those that
    /// touch at the start, and the times. Each has vertex/face and edge/edge.
    nb::tuple run(const device_request& of, bool initial_contact, bool first_contact, bool times,
                  double t_max) {
        const std::unique_lock held(mutex_, std::try_to_lock);
        if (!held)
            throw std::runtime_error("Steps: another call is under way; expected one at a time");
        ccd::cuda::mesh_steps::result found;
        std::vector<memory> copies;
        device_ = of.device;
        on_device(device_, [&] {
            found = steps_->run(of.at, {of.method, of.precision, of.stream, initial_contact,
                                        first_contact, times, t_max});
            check(found);
            const auto copy = [&](const auto& lists) {
                copies.emplace_back(lists.template of<ccd::kind::vertex_face>(), of.stream);
                copies.emplace_back(lists.template of<ccd::kind::edge_edge>(), of.stream);
            };
            copy(found.pairs), copy(found.touching_at_start), copy(found.times);
            check(cudaStreamSynchronize(of.stream));
        });
        nb::list lists;
        for (memory& items : copies) lists.append(owned(std::move(items)));
        return nb::make_tuple(found.candidates.vertex_face, found.candidates.edge_edge,
                              time_of(found.first_contact), lists);
    }

  private:
    std::optional<ccd::cuda::mesh_steps> steps_;
    int device_ = 0;
    std::mutex mutex_;
};

/// An array of another library, imported from a DLPack capsule.
struct imported {
    nb::ndarray<nb::ro> array;

    /// Returns device type, device, address, (code, bits, lanes), shape, strides in items.
    nb::tuple description() const {
        const auto numbers = [&](const std::int64_t* from) {
            return std::vector<std::int64_t>(from, from + array.ndim());
        };
        const nb::dlpack::dtype type = array.dtype();
        return nb::make_tuple(array.device_type(), array.device_id(), address(array.data()),
                              nb::make_tuple(type.code, type.bits, type.lanes),
                              numbers(array.shape_ptr()), numbers(array.stride_ptr()));
    }
};

/// Returns the device whose memory has this address, or -1.
int device_of(address p) {
    cudaPointerAttributes found{};
    check(cudaPointerGetAttributes(&found, reinterpret_cast<void*>(p)));
    const bool is_device =
        found.type == cudaMemoryTypeDevice || found.type == cudaMemoryTypeManaged;
    return is_device ? found.device : -1;
}

void wait_for(int device, address stream) {
    on_device(device,
              [&] { check(cudaStreamSynchronize(reinterpret_cast<ccd::cuda::stream>(stream))); });
}

using host_bytes = nb::ndarray<std::uint8_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
void copy_to_host(int device, address p, const host_bytes& to) {
    on_device(device, [&] {
        const auto* const from = reinterpret_cast<const void*>(p);
        if (p != 0) check(cudaMemcpy(to.data(), from, to.size(), cudaMemcpyDeviceToHost));
    });
}

}  // namespace
}  // namespace errbound::python

NB_MODULE(_cuda, m) {
    using namespace errbound::python;
    m.doc() = "Functions for errbound.cuda, which checks the arguments.";
    nb::class_<owned_memory>(m, "Memory")
        .def_ro("device", &owned_memory::device)
        .def_ro("bytes", &owned_memory::bytes)
        .def_prop_ro("address", [](const owned_memory& x) { return address(x.data.get()); });
    nb::class_<imported>(m, "Imported")
        .def(nb::init<nb::ndarray<nb::ro>>())
        .def("description", &imported::description);
    nb::class_<device_request>(m, "Request")
        .def(nb::init<int, address, const std::string&, bool, const frame&, const frame&, bool,
                      std::size_t>());
    nb::class_<device_steps>(m, "Steps")
        .def(nb::init<const input<std::uint32_t, -1, 3>&, std::size_t>())
        .def("run", &device_steps::run);
    m.def("decide_vertex_face", decide<ccd::vertex_face_pair>);
    m.def("decide_edge_edge", decide<ccd::edge_edge_pair>);
    m.def("first_times_vertex_face", first_times<ccd::vertex_face_pair>);
    m.def("first_times_edge_edge", first_times<ccd::edge_edge_pair>);
    m.def("capsule_of", capsule_of);
    m.def("device_of", device_of);
    m.def("wait", wait_for);
    m.def("read", copy_to_host);
    m.def("fault", [] { return ccd::cuda::device_status().error; });
}
