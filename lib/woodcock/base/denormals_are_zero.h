// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace woodcock {

/// While it lives, this thread's processor takes denormal numbers (floats below 1.2e-38) for 0.
/// Many processors are a hundred times slower with them, and one in a vector slows all of it.
/// Where there is no SSE it does nothing.
class DenormalsAreZero {
public:
#ifdef __SSE__
    DenormalsAreZero() { _mm_setcsr(before_ | operandsAreZero | resultsAreZero); }
    ~DenormalsAreZero() { _mm_setcsr(before_); }
#else
    DenormalsAreZero() {}
    ~DenormalsAreZero() {}
#endif
    DenormalsAreZero(const DenormalsAreZero&) = delete;
    DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

private:
#ifdef __SSE__
    static constexpr unsigned operandsAreZero = 1u << 6, resultsAreZero = 1u << 15;
    const unsigned before_ = _mm_getcsr();
#endif
};

}  // namespace woodcock
