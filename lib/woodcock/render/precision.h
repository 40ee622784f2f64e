// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace woodcock {

struct Scene;

/// Where the numbers of a scene are beyond what double and float can tell apart, one sentence for
/// each: what, where, by how much, and what to do. Nothing for scenes of ordinary size.
std::vector<std::string> precisionWarnings(const Scene& scene);

}  // namespace woodcock
