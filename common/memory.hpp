// What a process does with the memory that it frees.
#pragma once

#include <malloc.h>

namespace common {

/// Freed memory stays with the process. The images of frames and splits (half a megabyte each with 1200 particles) come
/// and go at each exchange, and glibc would give their pages back and fault them in again: seven of ten page faults of
/// `xfem serve`, a twentieth of what the exchange costs.
inline void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace common
