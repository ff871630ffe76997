// The heap's peak: this program counts what operator new gives and operator delete takes.
//
// Not seen: memory from malloc (big integers of the reference, the thread library's own).
#pragma once

#include <cstddef>

namespace bench {

namespace heap {
void start();        ///< counts from now on
std::size_t stop();  ///< the peak since start()
}  // namespace heap

/// The most bytes that were allocated at once within `work`, above what was allocated before it.
template <class Work>
std::size_t peak_heap(const Work& work) {
    heap::start();
    work();
    return heap::stop();
}

}  // namespace bench
