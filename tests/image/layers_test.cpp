// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/layers.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "tests/support/expect_error.h"
#include "woodcock/base/nearest_name.h"

namespace woodcock::test {

using namespace image;

namespace {

using Names = std::vector<std::string>;

Names namesOf(const LayerList& layers) {
    Names names;
    for (const ChosenLayer& chosen : layers) names.push_back(chosen.layer.name);
    return names;
}

TEST(Layers, StandInTheOrderOfTheTable) {
    EXPECT_EQ(namesOf(layersFromNames({"variance", "depth", "emission"})),
              (Names{"depth", "emission", "variance"}));
    EXPECT_EQ(namesOf(layersFromNames({"default"})), Names{});
    EXPECT_EQ(namesOf(layersFromNames({})), Names{});
}

TEST(Layers, AllAreAllOfTheTableAndTheGroupsOfTheScene) {
    const LayerList all = layersFromNames({"all"});
    EXPECT_EQ(all.size(), layerTable().size());
    Names expected = namesOf(all);
    expected.insert(expected.end(), {"lightgroup_rest", "lightgroup_key", "lightgroup_fill"});
    EXPECT_EQ(namesOf(layersFromNames({"all"}, {"key", "fill"})), expected);
    EXPECT_EQ(namesOf(layersFromNames({"lightgroups"}, {"key", "fill"})),
              (Names{"lightgroup_rest", "lightgroup_key", "lightgroup_fill"}));
    EXPECT_EQ(namesOf(layersFromNames({"lightgroup_fill", "lightgroup_rest"}, {"key", "fill"})),
              (Names{"lightgroup_rest", "lightgroup_fill"}));
}

/// A layer begins with its name, so that compositors make one of its channels; or it has one
/// channel. No channel is there twice.
TEST(Layers, ChannelsAreOfTheLayerAndDiffer) {
    std::set<std::string> seen{"R", "G", "B", "A"};
    for (const auto& [layer, half] : layersFromNames({"all"}, {"key"})) {
        for (const std::string& channel : layer.channels) {
            EXPECT_TRUE(seen.insert(channel).second) << channel;
            const bool prefixed = channel.starts_with(layer.name + ".");
            EXPECT_TRUE(prefixed || layer.channels.size() == 1) << channel;
            EXPECT_EQ(layer.nameInPart(channel).find('.'), std::string::npos) << channel;
            EXPECT_LE(channel.size(), 63u) << channel;
        }
        EXPECT_FALSE(layer.doc.empty()) << layer.name;
        // Its name may not be a group's.
        if (!layer.name.starts_with(groupPrefix)) {
            EXPECT_NE(flawOfGroupName(layer.name), "") << layer.name;
        }
    }
}

/// What Nuke's reader makes of a channel's name, by the comment in The Foundry's
/// ExrChannelNameToNuke.cpp (NDK 11.3 to 17.1): it is cut at two periods, digits at the start of
/// each part are deleted, what is neither letter nor digit becomes _, all but the last part are the
/// layer. In files of many parts, the part's name comes first.
std::pair<std::string, std::string> inNuke(const std::string& name) {
    Names parts;
    std::string rest = name;
    for (std::size_t dot; parts.size() < 2 && (dot = rest.find('.')) != rest.npos;)
        parts.push_back(rest.substr(0, dot)), rest = rest.substr(dot + 1);
    parts.push_back(rest);
    std::string layer, channel;
    for (std::string part : parts) {
        part.erase(0, std::min(part.find_first_not_of("0123456789"), part.size()));
        for (char& c : part)
            if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
        if (part.empty()) continue;
        if (!channel.empty()) layer += (layer.empty() ? "" : "_") + channel;
        channel = part;
    }
    const Names letters{"R", "G", "B", "A"}, words{"red", "green", "blue", "alpha"};
    for (std::size_t i = 0; i < letters.size(); ++i)
        if (channel == letters[i]) channel = words[i];
    return {layer, channel};
}

/// Each keeps its name there, in one part and in many, and no two become one.
TEST(Layers, KeepTheirNamesInNuke) {
    EXPECT_EQ(inNuke("2nd.1.key-light.R"),
              (std::pair<std::string, std::string>{"nd", "key_light_R"}));
    std::set<std::pair<std::string, std::string>> one{{"", "red"}}, many{{"rgba", "red"}};
    for (const auto& [layer, half] : layersFromNames({"all"}, {"key", "2nd_fill"}))
        for (const std::string& channel : layer.channels) {
            const auto name = inNuke(channel);
            EXPECT_TRUE(one.insert(name).second) << channel;
            if (channel.find('.') != channel.npos) {
                EXPECT_EQ(name.first, layer.name) << channel;
            }
            const auto part = inNuke(layer.name + "." + layer.nameInPart(channel));
            EXPECT_TRUE(many.insert(part).second) << channel;
            EXPECT_EQ(part.first, layer.name) << channel;
        }
}

TEST(Layers, PrecisionIsOfEachLayerOrOfAllThatBearIt) {
    const auto halves = [](const Names& names, bool half) {
        Names found;
        for (const ChosenLayer& chosen : layersFromNames(names, {"key"}, half))
            if (chosen.half) found.push_back(chosen.layer.name);
        return found;
    };
    EXPECT_EQ(halves({"depth", "emission", "lightgroup_key:half"}, false), Names{"lightgroup_key"});
    EXPECT_EQ(halves({"depth", "emission", "albedo:float", "position", "variance"}, true),
              Names{"emission"});
    EXPECT_EQ(halves({"all", "emission:half"}, false), Names{"emission"});
    for (const std::string& name : halves({"all"}, true))
        for (const char* exact : {"depth", "position", "motion", "samples", "error", "variance"})
            EXPECT_FALSE(name.starts_with(exact)) << name;
}

TEST(Layers, NeedWhatFillsThemAndNothingElse) {
    const auto needs = [](const Names& names) {
        return needsOf(layersFromNames(names, {"key"}), {"key"});
    };
    EXPECT_FALSE(needs({"samples", "error", "variance"}).depthSamples());
    EXPECT_EQ(needs({"samples"}).parts.count(), 0u);
    EXPECT_TRUE(needs({"transmittance"}).depth);
    EXPECT_TRUE(needs({"normal"}).features);
    EXPECT_TRUE(needs({"motion"}).places && needs({"position"}).places);
    EXPECT_TRUE(needs({"depth_half"}).stops && !needs({"depth_half"}).depthSamples());
    EXPECT_EQ(needs({"emission"}).parts.count(), lightKindNames.size());
    EXPECT_EQ(needs({"lightgroup_key"}).parts.count(), 2u);
    const LightParts both = needs({"all"}).parts;
    EXPECT_EQ(both.count(), lightKindNames.size() + 2);
    EXPECT_EQ(both.name(both.placeOf(LightKind::Background)), "background");
    EXPECT_EQ(both.name(both.placeOf(LightGroup{0})), "lightgroup_rest");
    EXPECT_EQ(both.name(both.placeOf(LightGroup{1})), "lightgroup_key");
}

TEST(Layers, MistakesAreSaid) {
    const auto mistake = [](const Names& names, const Names& groups = {}) {
        return messageOf(ErrorKind::Usage, [&] { layersFromNames(names, groups); });
    };
    EXPECT_EQ(
        mistake({"depth", "sample"}),
        "unknown layer 'sample'; did you mean 'samples'? known layers: " + joinNames(layerNames()));
    EXPECT_EQ(mistake({"depth", "depth:float"}), "the layer 'depth' is named twice");
    EXPECT_EQ(mistake({"default", "depth"}),
              "'default' stands for no layers, and 'depth' is one; give one of them");
    EXPECT_EQ(mistake({"default:half"}),
              "'default' is no layer that could be half: it stands for none");
    EXPECT_EQ(mistake({"emission:double"}),
              "'double' is no precision of the layer 'emission'; a layer is half or float, as in "
              "emission:half");
    EXPECT_EQ(mistake({"position:half"}),
              "the layer 'position' is float always: half precision would harm it");
    EXPECT_EQ(mistake({"lightgroups"}),
              "the scene has no light groups: no light, volume or emissive material says group = "
              "\"key\"");
    EXPECT_EQ(mistake({"lightgroup_kye"}, {"key"}),
              "the scene has no light group for the layer 'lightgroup_kye'; did you mean "
              "'lightgroup_key'? its layers of groups: lightgroup_rest, lightgroup_key");
}

TEST(Layers, NamesOfGroupsAreThoseThatCompositorsHold) {
    for (const char* good : {"key", "Key-2", "2nd_fill", "_"}) EXPECT_EQ(flawOfGroupName(good), "");
    EXPECT_EQ(flawOfGroupName(""), "is empty; leave the key out, and the light counts to the rest");
    EXPECT_EQ(flawOfGroupName("emission"), "is the name of a layer; take another one");
    EXPECT_EQ(flawOfGroupName("all"), "is the name of a layer; take another one");
    EXPECT_EQ(flawOfGroupName("rest"),
              "is the name of the layer of all lights without a group; take another one");
    EXPECT_EQ(
        flawOfGroupName("key light"),
        "holds ' '; names of layers hold letters, digits, _ and -, or compositors rename them");
    EXPECT_EQ(flawOfGroupName("a.b").substr(0, 9), "holds '.'");
    EXPECT_EQ(flawOfGroupName("lumi\u00e8re").substr(0, 10), "holds '\u00e8'");
    EXPECT_EQ(flawOfGroupName(std::string(49, 'k')),
              "is 49 characters long; Blender cuts layers beyond 48");
}

}  // namespace
}  // namespace woodcock::test
