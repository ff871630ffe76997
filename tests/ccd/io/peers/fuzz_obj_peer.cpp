// Fuzzes the OBJ reader and tinyobjloader's.
#include "tests/ccd/io/peers/fuzz_peer.hpp"
