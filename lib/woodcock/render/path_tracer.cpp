// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/path_tracer.h"

#include "woodcock/render/batch_tracer.h"

namespace woodcock::render {

namespace {

template <int N>
std::unique_ptr<PathTracer> makeFor(const Scene& scene, const Needs& needs,
                                    const PathTracer::Options& options) {
    if (needs.surfaces) return std::make_unique<BatchTracer<N, true>>(scene, needs, options);
    return std::make_unique<BatchTracer<N, false>>(scene, needs, options);
}

}  // namespace

std::unique_ptr<PathTracer> PathTracer::make(const Scene& scene, const Needs& needs,
                                             const Options& options) {
    return needs.chromatic ? makeFor<3>(scene, needs, options) : makeFor<1>(scene, needs, options);
}

}  // namespace woodcock::render
