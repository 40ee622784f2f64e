// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::test {

inline constexpr const char* fogScene = R"([[volume]]
box = { min = [-1, -1, -1], max = [1, 1, 1] }
scale = 1.5
albedo = 0.8
g = 0.3
[[light]]
type = "environment"
[camera]
eye = [2, 1, 4]
look_at = [0, 0, 0]
fov = 30
[render]
resolution = [24, 24]
spp = 256
)";

}  // namespace woodcock::test
