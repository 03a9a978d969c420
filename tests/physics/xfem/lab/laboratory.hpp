// A laboratory test made in code.
#pragma once

#include "xfem/lab/kinds.hpp"

namespace laboratory {

inline common::LabTest test_of(common::LabTestKind kind, int nodes) {
  common::LabTest test;
  test.test = kind;
  test.mesh_nodes = nodes;
  test.breakage.minimum_area = 0;
  return test;
}

inline xfem::LabResult run(const common::LabTest& test) {
  return xfem::run(xfem::lab_setup(test), test);
}

}  // namespace laboratory
