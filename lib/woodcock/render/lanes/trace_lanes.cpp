// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/lanes/trace_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "woodcock/render/lanes/trace_lanes.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)  // no faster here than SSE4 and AVX3
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "woodcock/base/denormals_are_zero.h"
#include "woodcock/render/lanes/lane_camera-inl.h"
#include "woodcock/render/lanes/lane_collisions-inl.h"
#include "woodcock/render/lanes/lane_emission-inl.h"
#include "woodcock/render/lanes/lane_expected-inl.h"
#include "woodcock/render/lanes/lane_paths-inl.h"
#include "woodcock/render/lanes/lane_scattering-inl.h"
#include "woodcock/render/lanes/lane_sun-inl.h"
#include "woodcock/render/lanes/lane_walk-inl.h"

// Highway includes this file once for each set of instructions, and chooses one when the program
// runs.

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

template <int N>
void trace(const LaneScene& scene, Batch<N, false>& batch) {
    LaneTracer<N> tracer(scene, batch);
    tracer.run();
    batch.counters.distanceSegments += tracer.counters().segments;
    batch.counters.distanceCollisions += tracer.counters().collisions;
}
void traceGrey(const LaneScene& scene, Batch<1, false>& batch) { trace(scene, batch); }
void traceChromatic(const LaneScene& scene, Batch<3, false>& batch) { trace(scene, batch); }

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace woodcock::render {

HWY_EXPORT(traceGrey);
HWY_EXPORT(traceChromatic);

template <>
void traceLanes(const LaneScene& scene, Batch<1, false>& batch) {
    const DenormalsAreZero flush;
    HWY_DYNAMIC_DISPATCH(traceGrey)(scene, batch);
}
template <>
void traceLanes(const LaneScene& scene, Batch<3, false>& batch) {
    const DenormalsAreZero flush;
    HWY_DYNAMIC_DISPATCH(traceChromatic)(scene, batch);
}

}  // namespace woodcock::render
#endif
