// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/display.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cmath>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"

namespace woodcock::test {

using namespace image;
namespace {

/// IEC 61966-2-1.
double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<float, 4> shown(const ColorConfig& config, const DisplaySettings& settings, float r,
                           float g, float b) {
    std::array<float, 4> rgba{r, g, b, 0.25f};
    config.displayTransform(settings).apply(rgba);
    EXPECT_EQ(rgba[3], 0.25f);
    return rgba;
}

float grey(const ColorConfig& config, const DisplaySettings& settings, float v) {
    const auto rgba = shown(config, settings, v, v, v);
    EXPECT_NEAR(rgba[0], rgba[1], 1e-4);
    EXPECT_NEAR(rgba[2], rgba[1], 1e-4);
    return rgba[1];
}

class ShippedConfig : public testing::Test {
    const EnvironmentVariable none_{"OCIO", std::nullopt};

protected:
    const ColorConfig config_;
};

TEST_F(ShippedConfig, StandardIsTheDisplaysCurve) {
    for (float v : {0.0f, 0.001f, 0.18f, 0.5f, 1.0f}) {
        EXPECT_NEAR(grey(config_, {"sRGB", "Standard", "", 0}, v), srgb(v), 2e-5) << v;
        EXPECT_NEAR(grey(config_, {"Rec.1886", "Standard", "", 0}, v), std::pow(v, 1 / 2.4), 2e-5);
    }
    const auto red = shown(config_, {"sRGB", "Standard", "", 0}, 0.5f, 0, 0);
    EXPECT_NEAR(red[0], srgb(0.5), 2e-5);
    EXPECT_NEAR(red[1], 0, 2e-4);
    EXPECT_NEAR(red[2], 0, 2e-4);
}

TEST_F(ShippedConfig, RawChangesNothing) {
    EXPECT_EQ(grey(config_, {"sRGB", "Raw", "", 0}, 0.18f), 0.18f);
    EXPECT_EQ(grey(config_, {"sRGB", "Raw", "", 0}, 7.0f), 7.0f);
}

TEST_F(ShippedConfig, AcesShowsMidGreyAsItsSpecificationSays) {
    // ACES 1.0: scene-linear 0.18 is 4.8 cd/m2 in a cinema of 0.02 to 48 cd/m2; the video transform
    // raises that to the power 0.9811 for a dim surround.
    const double linear = std::pow((4.8 - 0.02) / (48 - 0.02), 0.9811);
    EXPECT_NEAR(grey(config_, {"sRGB", "ACES", "", 0}, 0.18f), srgb(linear), 2e-4);
    EXPECT_NEAR(grey(config_, {"Rec.1886", "ACES", "", 0}, 0.18f), std::pow(linear, 1 / 2.4), 2e-4);
    EXPECT_NEAR(grey(config_, {"sRGB", "ACES", "", 0}, 0), 0, 1e-3);
    // 6.5 stops above mid-grey is where the curve reaches its white.
    EXPECT_NEAR(grey(config_, {"sRGB", "ACES", "", 0}, 0.18f * std::exp2(6.5f)), 1, 1e-3);
}

TEST_F(ShippedConfig, AcesOnSrgbIsTheDefault) {
    EXPECT_EQ(grey(config_, {}, 0.3f), grey(config_, {"sRGB", "ACES", "", 0}, 0.3f));
    EXPECT_EQ(grey(config_, {"Rec.1886", "", "", 0}, 0.3f),
              grey(config_, {"Rec.1886", "ACES", "", 0}, 0.3f));
}

TEST_F(ShippedConfig, ExposureIsInStopsOfSceneLight) {
    for (const char* view : {"Standard", "ACES", "Raw"}) {
        EXPECT_NEAR(grey(config_, {"sRGB", view, "", 1.5}, 0.1f),
                    grey(config_, {"sRGB", view, "", 0}, 0.1f * std::exp2(1.5f)), 1e-5);
        EXPECT_NEAR(grey(config_, {"sRGB", view, "", -3}, 0.8f),
                    grey(config_, {"sRGB", view, "", 0}, 0.1f), 1e-5);
    }
}

TEST_F(ShippedConfig, WorksInLinearRec709) {
    EXPECT_EQ(config_.chromaticities(), chromaticitiesFromName("Rec.709"));
    EXPECT_EQ(config_.note(), "");
}

TEST_F(ShippedConfig, UnknownNamesListTheKnown) {
    const auto message = [&](const DisplaySettings& settings) {
        return messageOf(ErrorKind::Usage, [&] { config_.displayTransform(settings); });
    };
    EXPECT_EQ(message({"sRGB", "Filmc", "", 0}),
              "view 'Filmc' not found for display 'sRGB' in the OpenColorIO config that Woodcock "
              "ships; it has: ACES, Standard, Raw");
    EXPECT_EQ(message({"P3", "", "", 0}),
              "display 'P3' not found in the OpenColorIO config that "
              "Woodcock ships; it has: sRGB, Rec.1886");
    EXPECT_EQ(message({"", "", "Punchy", 0}),
              "look 'Punchy' not found in the OpenColorIO config "
              "that Woodcock ships; it has: none");
    EXPECT_EQ(message({"", "", "", std::nan("")}),
              "exposure nan is out of range: -100 to 100 stops");
    EXPECT_EQ(message({"srgb", "standard", "", 0}), "no error");  // letter case aside
}

/// A config of Blender's shape: tables found through a search path, looks in a space of their own.
class ConfigWithTables : public testing::Test {
protected:
    ConfigWithTables() {
        std::filesystem::create_directory(dir_ / "tables");
        // Doubles below 0.5, white above.
        writeText(dir_ / "tables/filmic.spi1d",
                  "Version 1\nFrom 0 1\nLength 3\nComponents 1\n{\n0\n1\n1\n}\n");
    }

    std::filesystem::path write(const std::string& version, const std::string& extraView = "") {
        writeText(
            dir_ / "config.ocio",
            fmt::format(R"(ocio_profile_version: {}

search_path: "luts:tables"
strictparsing: true
luma: [0.2126, 0.7152, 0.0722]

roles:
  reference: Linear
  scene_linear: Linear
  data: Raw
  default: Raw

file_rules:
  - !<Rule> {{name: Default, colorspace: default}}

displays:
  sRGB:
    - !<View> {{name: Filmic, colorspace: Filmic}}
    - !<View> {{name: Darker, colorspace: Filmic, looks: Darker}}
{}
colorspaces:
  - !<ColorSpace>
    name: Linear
    aliases: [lin_ap1]

  - !<ColorSpace>
    name: Raw
    isdata: true

  - !<ColorSpace>
    name: Filmic
    from_scene_reference: !<FileTransform> {{src: filmic.spi1d, interpolation: linear}}

  - !<ColorSpace>
    name: New
    from_scene_reference: !<BuiltinTransform> {{style: {}}}

looks:
  - !<Look>
    name: Darker
    process_space: Linear
    transform: !<CDLTransform> {{slope: [0.5, 0.5, 0.5]}}
)",
                        version, extraView, extraView.empty() ? "IDENTITY" : "OF - THE FUTURE"));
        return dir_ / "config.ocio";
    }

    const EnvironmentVariable none_{"OCIO", std::nullopt};
    const TempDir dir_;
};

TEST_F(ConfigWithTables, FindsItsFilesAndLooks) {
    const ColorConfig config(write("2.1"));
    EXPECT_EQ(config.note(), "");
    EXPECT_NEAR(grey(config, {}, 0.2f), 0.4f, 1e-5);
    EXPECT_NEAR(grey(config, {"", "Darker", "", 0}, 0.2f), 0.2f, 1e-5);
    EXPECT_NEAR(grey(config, {"", "", "Darker", 1}, 0.2f), 0.4f, 1e-5);
    EXPECT_NEAR(grey(config, {"", "", "Darker, +Darker", 0}, 0.2f), 0.1f, 1e-5);
    EXPECT_EQ(config.chromaticities(), chromaticitiesFromName("ACEScg"));
}

TEST_F(ConfigWithTables, OneOfALaterVersionIsUsedAsFarAsItGoes) {
    const ColorConfig config(write("2.99", "    - !<View> {name: New, colorspace: New}\n"));
    EXPECT_NEAR(grey(config, {"", "Filmic", "", 0}, 0.2f), 0.4f, 1e-5);
    EXPECT_NE(config.note().find("is of version 2.99 and was read by OpenColorIO"),
              std::string::npos);
    EXPECT_NE(config.note().find("need the built-in transform 'OF - THE FUTURE'"),
              std::string::npos);
    const std::string message = messageOf(ErrorKind::Usage, [&] {
        config.displayTransform({"sRGB", "New", "", 0});
    });
    EXPECT_NE(message.find("view 'New' of display 'sRGB' needs 'OF - THE FUTURE' of OpenColorIO "
                           "2.99; this build has"),
              std::string::npos)
        << message;
}

TEST_F(ConfigWithTables, ExplicitComesBeforeTheVariableBeforeTheShippedOne) {
    const std::filesystem::path file = write("2");
    const EnvironmentVariable variable("OCIO", file.string());
    EXPECT_NEAR(grey(ColorConfig(), {}, 0.2f), 0.4f, 1e-5);
    const ColorConfig named(sourceDir() / "data/ocio/woodcock.ocio");
    EXPECT_NEAR(grey(named, {"", "Standard", "", 0}, 0.2f), srgb(0.2), 2e-5);
    const EnvironmentVariable empty("OCIO", "");
    EXPECT_NEAR(grey(ColorConfig(), {"", "Standard", "", 0}, 0.2f), srgb(0.2), 2e-5);
}

TEST_F(ConfigWithTables, ErrorsNameTheConfigAndTheReason) {
    const auto message = [](const std::filesystem::path& file) {
        return messageOf(ErrorKind::Input, [&] { ColorConfig config(file); });
    };
    EXPECT_EQ(message("/nowhere/config.ocio"),
              "cannot read the OpenColorIO config '/nowhere/config.ocio': there is no such file");
    EXPECT_NE(message(write("3.0")).find("is of version 3.0; this build's OpenColorIO"),
              std::string::npos);
    writeText(dir_ / "no.ocio", "ocio_profile_version: 2\nroles: [\n");
    EXPECT_NE(message(dir_ / "no.ocio").find("no.ocio' cannot be used: "), std::string::npos);

    const EnvironmentVariable variable("OCIO", "/nowhere/config.ocio");
    EXPECT_EQ(
        message({}),
        "cannot read the OpenColorIO config of $OCIO '/nowhere/config.ocio': there is no such "
        "file");
}

TEST_F(ConfigWithTables, AMissingTableIsNamed) {
    const ColorConfig config(write("2.1"));
    std::filesystem::remove(dir_ / "tables/filmic.spi1d");
    const std::string message = messageOf(ErrorKind::Input, [&] {
        config.displayTransform({"", "Filmic", "", 0});
    });
    EXPECT_NE(message.find("view 'Filmic'"), std::string::npos) << message;
    EXPECT_NE(message.find("filmic.spi1d"), std::string::npos) << message;
}

/// A config with these looks, colour spaces and views beside the plain ones.
class HostileConfig : public testing::Test {
protected:
    std::string refusal(const std::string& spaces, const std::string& looks = "",
                        const std::string& views = "") const {
        writeText(dir_ / "c.ocio",
                  "ocio_profile_version: 2\nenvironment: {}\n"
                  "search_path: .\nroles: {default: lin, scene_linear: lin}\n"
                  "file_rules:\n  - !<Rule> {name: Default, colorspace: lin}\n"
                  "displays:\n  sRGB:\n    - !<View> {name: A, colorspace: "
                  "lin}\n" +
                      views + "looks:\n" + looks +
                      "  - !<Look> {name: plain, process_space: lin}\n"
                      "colorspaces:\n  - !<ColorSpace> {name: lin}\n"
                      "  - !<ColorSpace> {name: log}\n" +
                      spaces);
        return messageOf(ErrorKind::Input, [&] {
            const ColorConfig config(dir_ / "c.ocio");
            config.displayTransform({});
        });
    }
    static std::string space(const std::string& name, const std::string& transform) {
        return fmt::format("  - !<ColorSpace>\n    name: {}\n    from_scene_reference: {}\n", name,
                           transform);
    }
    const EnvironmentVariable none_{"OCIO", std::nullopt};
    const TempDir dir_;
};

TEST_F(HostileConfig, CirclesAreRefused) {
    const auto expectCircle = [](const std::string& message, const std::string& circle) {
        EXPECT_NE(message.find("refers to itself: " + circle), std::string::npos) << message;
    };
    EXPECT_EQ(refusal(""), "no error");
    expectCircle(refusal("",
                         "  - !<Look> {name: warm, process_space: lin, transform: "
                         "!<LookTransform> {src: lin, dst: lin, looks: warm}}\n"),
                 "look 'warm' -> look 'warm'");
    expectCircle(refusal("",
                         "  - !<Look> {name: a, process_space: lin, transform: "
                         "!<LookTransform> {src: lin, dst: lin, looks: \"plain, -b\"}}\n"
                         "  - !<Look> {name: b, process_space: lin, transform: "
                         "!<LookTransform> {src: lin, dst: lin, looks: +a}}\n"),
                 "look 'a' -> look 'b' -> look 'a'");
    expectCircle(refusal(space("self", "!<ColorSpaceTransform> {src: lin, dst: self}")),
                 "colour space 'self' -> colour space 'self'");
    expectCircle(refusal(space("one",
                               "!<GroupTransform> {children: [!<ColorSpaceTransform> {src: "
                               "lin, dst: two}]}") +
                         space("two", "!<ColorSpaceTransform> {src: one, dst: lin}")),
                 "colour space 'one' -> colour space 'two' -> colour space 'one'");
    expectCircle(refusal(space("shown",
                               "!<DisplayViewTransform> {src: lin, display: sRGB, view: "
                               "Round}"),
                         "", "    - !<View> {name: Round, colorspace: shown}\n"),
                 "colour space 'shown' -> view 'sRGB/Round' -> colour space 'shown'");
    expectCircle(refusal(space("graded", "!<LookTransform> {src: lin, dst: lin, looks: own}"),
                         "  - !<Look> {name: own, process_space: graded}\n"),
                 "colour space 'graded' -> look 'own' -> colour space 'graded'");
}

TEST_F(HostileConfig, ReferencesThatLeadSomewhereAreFollowed) {
    std::string spaces = space("c0", "!<MatrixTransform> {offset: [0.1, 0.1, 0.1, 0]}");
    for (int i = 1; i < 20; ++i)
        spaces += space(fmt::format("c{}", i),
                        fmt::format("!<ColorSpaceTransform> {{src: lin, dst: c{}}}", i - 1));
    EXPECT_EQ(refusal(spaces), "no error");
}

TEST_F(HostileConfig, WhatTakesTooManyStepsIsRefused) {
    const auto group = [](const std::string& a) {
        return fmt::format("!<GroupTransform> {{children: [{0}, {0}]}}", a);
    };
    std::string doubling = space("c0", "!<MatrixTransform> {offset: [0.1, 0.1, 0.1, 0]}"),
                chain = doubling;
    std::string aliases =
        space("c0", "&a0 " + group("!<MatrixTransform> {offset: [0.1, 0.1, 0.1, 0]}"));
    for (int i = 1; i < 40; ++i) {
        const std::string to = fmt::format("!<ColorSpaceTransform> {{src: lin, dst: c{}}}", i - 1);
        doubling += space(fmt::format("c{}", i), group(to));
        aliases += space(fmt::format("c{}", i),
                         fmt::format("&a{} {}", i, group(fmt::format("*a{}", i - 1))));
    }
    for (int i = 1; i < 3000; ++i)
        chain += space(fmt::format("c{}", i),
                       fmt::format("!<ColorSpaceTransform> {{src: lin, dst: c{}}}", i - 1));
    EXPECT_NE(refusal(doubling).find("takes more than 100000 steps"), std::string::npos);
    EXPECT_NE(refusal(aliases).find("aliases stand for more than 100000"), std::string::npos);
    std::string reversed;  // the last one first, as one that is met first is followed first
    for (int i = 2999; i > 0; --i)
        reversed += space(fmt::format("c{}", i),
                          fmt::format("!<ColorSpaceTransform> {{src: lin, dst: c{}}}", i - 1));
    EXPECT_NE(refusal(reversed + space("c0", "!<MatrixTransform> {offset: [0.1, 0.1, 0.1, 0]}"))
                  .find("a chain of more than 100 references"),
              std::string::npos);
}

TEST_F(HostileConfig, TablesAreRegularFiles) {
    ASSERT_EQ(mkfifo((dir_ / "pipe.cube").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", dir_ / "zero.cube");
    EXPECT_NE(refusal(space("t", "!<FileTransform> {src: pipe.cube}")).find("it is a pipe"),
              std::string::npos);
    EXPECT_NE(refusal(space("t", "!<FileTransform> {src: zero.cube}")).find("it is a device"),
              std::string::npos);
    writeText(dir_ / "a.ctf",
              "<ProcessList version=\"2\" id=\"a\"><Reference path=\"pipe.cube\" "
              "inBitDepth=\"32f\" outBitDepth=\"32f\"/></ProcessList>");
    EXPECT_NE(refusal(space("t", "!<FileTransform> {src: a.ctf}")).find("it is a pipe"),
              std::string::npos);
}

TEST_F(HostileConfig, NumbersBeyondAllBoundsAreRefusedInWords) {
    for (const std::string version : {"9223372036854775807", "99999999999999999999.5"}) {
        writeText(dir_ / "v.ocio", "ocio_profile_version: " + version + "\n");
        expectError(ErrorKind::Input, "v.ocio' is of version ",
                    [&] { ColorConfig config(dir_ / "v.ocio"); });
    }
    // A million digits took all of the stack.
    writeText(dir_ / "v.ocio", "ocio_profile_version: " + std::string(1000000, '1') + "\n");
    expectError(ErrorKind::Input, "v.ocio' is of version ",
                [&] { ColorConfig config(dir_ / "v.ocio"); });
}

}  // namespace
}  // namespace woodcock::test
