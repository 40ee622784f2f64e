// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/scene/keys/key.h"

namespace woodcock::test {

/// What is said of a table of keys, whatever it describes.
struct KeyList {
    std::string id;                    ///< "volume.blackbody"
    std::string tag;                   ///< of a light or a material: its type
    std::string outer, least;          ///< see KeyTable
    std::string path;                  ///< see KeyTable
    std::vector<scene::KeyInfo> keys;  ///< each name once
};

/// All tables of a scene file.
std::vector<KeyList> allKeys();

/// The table of the guide, data/scenes/README.md: Markdown, a line for each key.
std::string guideTable(const KeyList& list);

/// A guide's text whose tables, between the lines "<!-- keys: ID -->" and "<!-- end -->", are made
/// anew; of the ID "layers", that of the layers of an EXR. Throws Error{Input} on an unknown ID and
/// a table without an end.
std::string withGuideTables(const std::string& guide);

}  // namespace woodcock::test
