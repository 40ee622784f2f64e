// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/frame_files.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace proof;
using namespace scene;

namespace {

using Rule = OutsideRule;

/// What Blender 5 shows of a sequence (BKE_volume_sequence_frame), of files 1 + offset to
/// duration + offset: the number in the file's name. Nothing: clip.
std::optional<int> ofBlender(Rule rule, int frame, int start, int duration, int offset) {
    frame = frame - start + 1;
    if (rule == Rule::Black && (frame < 1 || frame > duration)) return std::nullopt;
    if (rule == Rule::Hold) frame = std::clamp(frame, 1, duration);
    if (rule == Rule::Repeat) {
        frame %= duration;
        if (frame < 0) frame += duration;
        if (frame == 0) frame = duration;
    }
    if (rule == Rule::PingPong) {
        const int period = duration * 2 - 2;
        frame %= period;
        if (frame < 0) frame += period;
        if (frame == 0) frame = period;
        if (frame > duration) frame = duration * 2 - frame;
    }
    return frame + offset;
}

TEST(FrameFiles, OutsideOfASequenceIsAsBlenderHasIt) {
    std::vector<int> files;
    for (int n = 9; n <= 20; ++n) files.push_back(n);
    for (const Rule rule : {Rule::Hold, Rule::Black, Rule::Repeat, Rule::PingPong})
        for (const int start : {1, 5, -3})
            for (int frame = -60; frame <= 60; ++frame)
                EXPECT_EQ(sequenceFile({start, 8, rule, {}}, frame, files),
                          ofBlender(rule, frame, start, 12, 8))
                    << static_cast<int>(rule) << ' ' << start << ' ' << frame;
    // Without rules, a file's number is the frame's.
    EXPECT_EQ(sequenceFile({}, 9, files), 9);
    expectError(ErrorKind::Input, "its files go from 9 to 20, and frame n shows file n. ",
                [&] { sequenceFile({}, 8, files); });
    // A single file has no way back.
    for (const Rule rule : {Rule::Hold, Rule::Repeat, Rule::PingPong})
        EXPECT_EQ(sequenceFile({1, 0, rule, {}}, 7, std::vector{3}), 3);
}

TEST(FrameFiles, HolesHaveARuleOfTheirOwn) {
    const std::vector<int> files{1, 2, 5, 6};
    const auto at = [&](int frame, MissingRule rule, Rule outside = Rule::Error) {
        return sequenceFile({1, 0, outside, rule}, frame, files);
    };
    EXPECT_EQ(at(4, MissingRule::Hold), 2);
    EXPECT_EQ(at(4, MissingRule::Black), std::nullopt);
    EXPECT_EQ(at(5, MissingRule::Error), 5);
    EXPECT_EQ(at(9, MissingRule::Hold, Rule::Repeat), 2);  // stands for 3
    expectError(ErrorKind::Input, "file 4 is missing between 2 and 5",
                [&] { at(4, MissingRule::Error, Rule::Black); });
    expectError(ErrorKind::Input, "its files go from 1 to 6", [&] { at(7, MissingRule::Hold); });
}

class SceneFrames : public testing::Test {
protected:
    SceneFrames() {
        for (int n = 2; n <= 4; ++n) {
            GridSpec grid;
            grid.name = "density";
            grid.box = {{0, 0, 0}, {7, 7, n == 3 ? 30 : 7}};
            grid.value = [n](Vec3i p) { return n + 0.1 * p.x; };
            writeVdb(dir / ("a." + std::to_string(n) + ".vdb"), {grid});
        }
    }
    SceneDescription parse(const std::string& text) const {
        return parseSceneText(text, "scene.toml", dir.path());
    }
    std::string volume(const std::string& more = "") const {
        return "[[volume]]\nfile = \"a.$F.vdb\"\nscale = 1\n" + more + "\n";
    }

    const TempDir dir;
    FrameFiles files;
};

TEST_F(SceneFrames, NamesAreFilledIn) {
    const SceneDescription scene =
        parse(volume() +
              "[[light]]\ntype = \"environment\"\nimage = \"sky.####.exr\"\n"
              "[output]\nfiles = [\"b.%03d.png\"]\n");
    EXPECT_TRUE(readsFrames(scene));
    const SceneDescription filled = files.at(scene, 3);
    EXPECT_EQ(filled.volumes[0].file, dir / "a.3.vdb");
    EXPECT_EQ(std::get<EnvironmentDescription>(filled.lights[0].light).image, dir / "sky.0003.exr");
    EXPECT_EQ(filled.output.files[0], dir / "b.003.png");
    EXPECT_FALSE(readsFrames(filled));
    EXPECT_EQ(files.atLargest(scene, 2).volumes[0].file, dir / "a.3.vdb");
    // The scene of a frame is the one that names its file itself.
    SceneDescription single = parse("[[volume]]\nfile = \"a.4.vdb\"\nscale = 1\n");
    const SceneDescription held = files.at(parse(volume("outside = \"extend\"")), 9);
    EXPECT_EQ(sceneDigest(held), sceneDigest(single));
}

TEST_F(SceneFrames, MistakesNameThePlace) {
    expectError(ErrorKind::Input,
                "scene.toml:2:8: " + (dir / "a.$F.vdb").string() + ": its files go from 2 to 4",
                [&] { files.at(parse(volume()), 9); });
    expectError(ErrorKind::Input, "with a frame's number in place of '####'",
                [&] { files.at(parse("[[volume]]\nfile = \"b.####.vdb\"\n"), 1); });
    expectError(ErrorKind::Input, "is for a sequence, and file names none",
                [&] { parse("[[volume]]\nfile = \"a.vdb\"\noffset = 2\n"); });
    expectError(ErrorKind::Input, "unknown rule 'loop'; known: error, hold, black, repeat",
                [&] { parse(volume("outside = \"loop\"")); });
}

TEST_F(SceneFrames, OneFileMayStandInForAll) {
    const SceneDescription one =
        parseSceneText(volume("offset = 3\noutside = \"hold\""), "scene.toml", dir.path(),
                       {"volume[0].file=a.2.vdb"});
    EXPECT_EQ(one.volumes[0].sequence, FileSequence());
}

TEST_F(SceneFrames, BlackFramesHoldNothing) {
    const SceneDescription black = files.at(parse(volume("outside = \"clip\"")), 9);
    EXPECT_TRUE(black.volumes[0].black);
    const LoadedScene loaded = loadScene(black);
    EXPECT_TRUE(loaded.volumes[0].density.field->extent().empty());
    EXPECT_TRUE(loaded.notes.empty());
}

TEST_F(SceneFrames, WhatFramesShareIsLoadedOnce) {
    const SceneDescription scene =
        parse(volume("outside = \"ping_pong\"\nblackbody = { temperature = \"density\" }") +
              "[[volume]]\nfile = \"a.2.vdb\"\nscale = 2\n");
    LoadCache cache;
    const LoadedScene four = loadScene(files.at(scene, 4), &cache),
                      five = loadScene(files.at(scene, 5), &cache),
                      again = loadScene(files.at(scene, 5), &cache);
    const auto density = [](const LoadedScene& loaded, std::size_t volume) {
        return loaded.volumes[volume].density.field;
    };
    EXPECT_NE(density(four, 0), density(five, 0));
    EXPECT_EQ(density(four, 1), density(five, 1));
    EXPECT_EQ(density(five, 0), density(again, 0));
    EXPECT_EQ(five.volumes[0].blackbody.field, again.volumes[0].blackbody.field);
    EXPECT_NE(four.volumes[0].blackbody.field, again.volumes[0].blackbody.field);
    // What a frame did not need is forgotten.
    const std::weak_ptr<const grid::Field> old = density(five, 0);
    EXPECT_EQ(density(loadScene(files.at(scene, 4), &cache), 0)->range().max,
              density(four, 0)->range().max);
    EXPECT_NE(density(loadScene(files.at(scene, 5), &cache), 0), old.lock());
}

}  // namespace
}  // namespace woodcock::test
