// Fuzzes the PLY reader and CGAL's.
#include "tests/ccd/io/peers/fuzz_peer.hpp"
