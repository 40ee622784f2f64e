// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace woodcock::render {

struct Scene;

/// Warnings where the numbers of a scene exceed the precision of double and float. Each is a
/// sentence that says what, where, by how much, and what to do. Empty for scenes of ordinary size.
std::vector<std::string> precisionWarnings(const Scene& scene);

}  // namespace woodcock::render
