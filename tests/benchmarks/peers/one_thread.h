#pragma once

#include <cstdlib>

namespace adamas::bench {

/// Before anything of VTK works in this process: it is to use no other thread. (vtkSMPTools.h, which says the
/// same, is no C++20.)
inline void keep_vtk_on_one_thread() { setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1); }

}  // namespace adamas::bench
