// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/config_adaptation.h"

#include <gtest/gtest.h>

namespace woodcock::test {

using namespace image;

namespace {

TEST(ConfigVersion, IsReadFromItsOwnLineOnly) {
    EXPECT_EQ(configVersion("ocio_profile_version: 2.4\n"), (ConfigVersion{2, 4}));
    EXPECT_EQ(configVersion("# comment\nocio_profile_version: 2\nname: x\n"),
              (ConfigVersion{2, 0}));
    EXPECT_EQ(configVersion("name: x # ocio_profile_version: 2.4\n"), (ConfigVersion{}));
    EXPECT_LT((ConfigVersion{1, 9}), (ConfigVersion{2, 0}));
    EXPECT_LT((ConfigVersion{2, 1}), (ConfigVersion{2, 10}));
}

TEST(AdaptConfig, ReplacesUnknownBuiltinsAndNothingElse) {
    const AdaptedConfig adapted = adaptConfig(R"(# about
ocio_profile_version: 2.4
a: !<BuiltinTransform> {style: KNOWN - A_to_B}
b: !<BuiltinTransform> {style: NEW - A_to_B_2.0}
c: !<BuiltinTransform> { style: "NEW - quoted", direction: inverse}
d: !<BuiltinTransform> {style: "KNOWN - A_to_B", direction: inverse}
e: !<BuiltinTransform> {style: NEW - A_to_B_2.0, direction: inverse}
description: ocio_profile_version: 2.4
)",
                                              {2, 1}, {"KNOWN - A_to_B"});
    EXPECT_EQ(adapted.text, R"(# about
ocio_profile_version: 2.1
a: !<BuiltinTransform> {style: KNOWN - A_to_B}
b: !<FileTransform> {src: "NEW - A_to_B_2.0"}
c: !<FileTransform> {src: "NEW - quoted", direction: inverse}
d: !<BuiltinTransform> {style: "KNOWN - A_to_B", direction: inverse}
e: !<FileTransform> {src: "NEW - A_to_B_2.0", direction: inverse}
description: ocio_profile_version: 2.4
)");
    EXPECT_EQ(adapted.missing, (std::vector<std::string>{"NEW - A_to_B_2.0", "NEW - quoted"}));
}

}  // namespace
}  // namespace woodcock::test
