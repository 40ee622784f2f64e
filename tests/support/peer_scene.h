// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/render/scene.h"

namespace woodcock::test {

/// A scene of `sharedDir()/images`, with the volumes of `sharedDir()/assets`.
render::Scene peerScene(const std::string& name);

}  // namespace woodcock::test
