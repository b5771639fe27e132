#pragma once

#include <cstdlib>

namespace adamas::bench {

/// Makes VTK use no other thread in this process. It has to be called before anything of VTK works.
/// (vtkSMPTools.h, which has the same function, is not valid C++20.)
inline void keep_vtk_on_one_thread() { setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1); }

}  // namespace adamas::bench
