// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_ROWS) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_ROWS
#undef WOODCOCK_LANE_ROWS
#else
#define WOODCOCK_LANE_ROWS
#endif

#include <bit>
#include <cstddef>

#include "woodcock/render/lanes/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// A number of each lane, in memory.
template <class T>
struct alignas(64) Row {
    static constexpr hn::ScalableTag<T> tag{};
    using V = hn::Vec<hn::ScalableTag<T>>;
    T lane[hn::MaxLanes(tag)];

    T& operator[](std::size_t i) { return lane[i]; }
    V get() const { return hn::Load(tag, lane); }
    void set(V v) { hn::Store(v, tag, lane); }
    template <class M>
    void set(M where, V v) {
        set(hn::IfThenElse(where, v, get()));
    }
};
using Floats = Row<float>;
using Ints = Row<std::int32_t>;

inline constexpr std::size_t laneCount = hn::MaxLanes(lanesF);
using Mask = hn::Mask<decltype(lanesF)>;
using MaskI = hn::Mask<decltype(lanesI)>;

inline MaskI ofInts(Mask mask) { return hn::RebindMask(lanesI, mask); }

/// The lanes in which a mask is true, as bits, and back.
inline std::uint32_t bitsOf(Mask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(lanesF, mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}
inline Mask maskOf(std::uint32_t bits) {
    Floats lanes;
    for (std::size_t i = 0; i < laneCount; ++i) lanes[i] = bits >> i & 1 ? 1.0f : 0.0f;
    return lanes.get() > hn::Zero(lanesF);
}
template <class A>
HWY_INLINE void forEachLane(std::uint32_t bits, A&& act) {
    for (; bits; bits &= bits - 1) act(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
