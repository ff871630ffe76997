// All of collision detection except devices (ccd/cuda.hpp) and ranks (ccd/mpi.hpp).
#pragma once

#include <ccd/advance.hpp>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/curves.hpp>
#include <ccd/exact.hpp>
#include <ccd/execution.hpp>
#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/bsc_exact.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/provot.hpp>
#include <ccd/methods/root_parity.hpp>
#include <ccd/methods/safeccd.hpp>
#include <ccd/methods/single_precision.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/nearness.hpp>
#include <ccd/plane.hpp>
#include <ccd/query.hpp>
#include <ccd/reference.hpp>
#include <ccd/step.hpp>
#include <ccd/verdict.hpp>
