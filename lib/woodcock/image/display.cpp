// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/display.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/regular_file.h"
#include "woodcock/image/config_adaptation.h"
#include "woodcock/image/opencolorio_graph.h"

namespace OCIO = OCIO_NAMESPACE;

namespace woodcock::image {

/// data/ocio/woodcock.ocio, compiled in.
extern const std::string_view shippedOcioConfig;

struct DisplayTransform::Processor {
    OCIO::ConstCPUProcessorRcPtr cpu;
};

struct ColorConfig::Impl {
    OCIO::ConstConfigRcPtr config;
    std::string origin;  ///< for messages
    std::string note;
    std::vector<std::filesystem::path> files;
    std::string version;               ///< that the config claims
    std::vector<std::string> missing;  ///< built-in transforms that it uses and the library lacks

    void parse(const std::string& text, const std::filesystem::path& directory);
    /// The settings with defaults filled in and names checked.
    DisplaySettings complete(DisplaySettings settings) const;
    Error cannotShow(const DisplaySettings& settings, std::string_view reason) const;
};

namespace {

ConfigVersion libraryVersion() {
    const int hex = OCIO::GetVersionHex();
    return {hex >> 24, (hex >> 16) & 0xff};
}

std::vector<std::string> builtinStyles() {
    const auto registry = OCIO::BuiltinTransformRegistry::Get();
    std::vector<std::string> styles;
    for (size_t i = 0; i < registry->getNumBuiltins(); ++i)
        styles.emplace_back(registry->getBuiltinStyle(i));
    return styles;
}

constexpr std::uint64_t largestConfig = 64 << 20;

/// Suppresses warnings about keys of later versions while such a config is read.
class SilentOcio {
public:
    SilentOcio() { OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE); }
    ~SilentOcio() { OCIO::SetLoggingLevel(before_); }
    SilentOcio(const SilentOcio&) = delete;
    SilentOcio& operator=(const SilentOcio&) = delete;

private:
    OCIO::LoggingLevel before_ = OCIO::GetLoggingLevel();
};

/// An archive, or what "ocio://" names.
OCIO::ConstConfigRcPtr archived(const std::string& name) {
    if (!name.starts_with("ocio://")) RegularFile(name, "the OpenColorIO config");
    return OCIO::Config::CreateFromFile(name.c_str());
}

/// OpenColorIO itself reads archives and "ocio://" names (2.2 and later).
bool isPlainFile(const std::string& name) {
    return !name.starts_with("ocio://") && !name.ends_with(".ocioz");
}

bool equalLetters(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& n) { return equalLetters(n, name); });
}

std::vector<std::string> displayNames(const OCIO::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumDisplays(); ++i) names.emplace_back(config.getDisplay(i));
    return names;
}

std::vector<std::string> viewNames(const OCIO::Config& config, const std::string& display) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
        names.emplace_back(config.getView(display.c_str(), i));
    return names;
}

std::vector<std::string> lookNames(const OCIO::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumLooks(); ++i) names.emplace_back(config.getLookNameByIndex(i));
    return names;
}

std::vector<std::string> spaceNames(const OCIO::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumColorSpaces(); ++i)
        names.emplace_back(config.getColorSpaceNameByIndex(i));
    return names;
}

std::string notAvailable(const std::vector<std::string>& styles) {
    if (styles.empty()) return {};
    return fmt::format("; views that need the built-in transform '{}'{} do not work",
                       styles.front(),
                       styles.size() == 1 ? "" : fmt::format(" and {} more", styles.size() - 1));
}

/// "+a, -b | c" is an expression, which OpenColorIO parses.
bool isPlainLook(const std::string& look) {
    return look.find_first_of(",|:") == std::string::npos && !look.starts_with('+') &&
           !look.starts_with('-');
}

bool meansNoLook(const std::string& look) { return equalLetters(look, "none"); }

OCIO::LegacyViewingPipelineRcPtr pipeline(const DisplaySettings& settings) {
    const auto toDisplay = OCIO::DisplayViewTransform::Create();
    toDisplay->setSrc(OCIO::ROLE_SCENE_LINEAR);
    toDisplay->setDisplay(settings.display.c_str());
    toDisplay->setView(settings.view.c_str());
    const double gain = std::exp2(settings.exposure);
    const double matrix[16] = {gain, 0, 0, 0, 0, gain, 0, 0, 0, 0, gain, 0, 0, 0, 0, 1};
    const auto exposure = OCIO::MatrixTransform::Create();
    exposure->setMatrix(matrix);

    const auto pipeline = OCIO::LegacyViewingPipeline::Create();
    pipeline->setDisplayViewTransform(toDisplay);
    pipeline->setLinearCC(exposure);
    pipeline->setLooksOverrideEnabled(!settings.look.empty());
    pipeline->setLooksOverride(meansNoLook(settings.look) ? "" : settings.look.c_str());
    return pipeline;
}

}  // namespace

void ColorConfig::Impl::parse(const std::string& text, const std::filesystem::path& directory) {
    const ConfigVersion wanted = configVersion(text), library = libraryVersion();
    version = fmt::format("{}.{}", wanted.major, wanted.minor);
    if (wanted.major > library.major)
        throw inputError(
            "the OpenColorIO config {} is of version {}; this build's OpenColorIO {} reads "
            "versions up to {}.{}",
            origin, version, OCIO::GetVersion(), library.major, library.minor);
    if (constexpr double mostNodes = 100000; yamlExpansion(text) > mostNodes)
        throw inputError(
            "the OpenColorIO config {} cannot be used: its YAML aliases stand for more than {:.0f} "
            "nodes",
            origin, mostNodes);
    std::istringstream stream(text);
    std::optional<SilentOcio> silence;
    if (wanted > library) {
        silence.emplace();
        AdaptedConfig adapted = adaptConfig(text, library, builtinStyles());
        missing = std::move(adapted.missing);
        note = fmt::format(
            "the OpenColorIO config {} is of version {} and was read by OpenColorIO {} as {}.{}{}",
            origin, version, OCIO::GetVersion(), library.major, library.minor,
            notAvailable(missing));
        stream.str(adapted.text);
    }
    const auto parsed = OCIO::Config::CreateFromStream(stream)->createEditableCopy();
    parsed->setWorkingDir(directory.c_str());  // where relative search paths begin
    config = parsed;
}

DisplaySettings ColorConfig::Impl::complete(DisplaySettings s) const {
    if (s.display.empty()) s.display = config->getDefaultDisplay();
    const std::vector<std::string> displays = displayNames(*config);
    if (!contains(displays, s.display))
        throw usageError("display '{}' not found in the OpenColorIO config {}; it has: {}",
                         s.display, origin, joinNames(displays));
    if (s.view.empty()) s.view = config->getDefaultView(s.display.c_str());
    const std::vector<std::string> views = viewNames(*config, s.display);
    if (!contains(views, s.view))
        throw usageError(
            "view '{}' not found for display '{}' in the OpenColorIO config {}; it has: {}", s.view,
            s.display, origin, joinNames(views));
    const std::vector<std::string> looks = lookNames(*config);
    if (!s.look.empty() && isPlainLook(s.look) && !contains(looks, s.look) && !meansNoLook(s.look))
        throw usageError("look '{}' not found in the OpenColorIO config {}; it has: {}{}", s.look,
                         origin, joinNames(looks), looks.empty() ? "" : ", or none for no look");
    if (!(std::abs(s.exposure) <= 100))
        throw usageError("exposure {} is out of range: -100 to 100 stops", s.exposure);
    return s;
}

Error ColorConfig::Impl::cannotShow(const DisplaySettings& s, std::string_view reason) const {
    for (const std::string& style : missing)
        if (reason.find(style) != std::string_view::npos)
            return usageError(
                "view '{}' of display '{}' needs '{}' of OpenColorIO {}; this build has {}: "
                "choose another view ({})",
                s.view, s.display, style, version, OCIO::GetVersion(),
                joinNames(viewNames(*config, s.display)));
    return inputError("the OpenColorIO config {} cannot show display '{}', view '{}'{}: {}", origin,
                      s.display, s.view, s.look.empty() ? "" : fmt::format(", look '{}'", s.look),
                      reason);
}

DisplayTransform::DisplayTransform(std::shared_ptr<const Processor> processor)
    : processor_(std::move(processor)) {}

void DisplayTransform::apply(std::span<float> rgba) const {
    if (rgba.empty()) return;
    OCIO::PackedImageDesc pixels(rgba.data(), static_cast<long>(rgba.size() / 4), 1, 4);
    processor_->cpu->apply(pixels);
}

ColorConfig::ColorConfig(const std::filesystem::path& file) : impl_(load(file)) {}

std::shared_ptr<const ColorConfig::Impl> ColorConfig::load(const std::filesystem::path& file) {
    const char* variable = std::getenv("OCIO");
    const bool fromVariable = file.empty() && variable && *variable;
    const std::string name = fromVariable ? std::string(variable) : file.string();

    const auto impl = std::make_shared<Impl>();
    impl->origin = name.empty() ? std::string("that Woodcock ships")
                                : fmt::format("'{}'{}", name, fromVariable ? " (of $OCIO)" : "");
    try {
        if (name.empty())
            impl->parse(std::string(shippedOcioConfig), {});
        else if (isPlainFile(name))
            impl->parse(readRegularFile(name,
                                        fromVariable ? "the OpenColorIO config of $OCIO"
                                                     : "the OpenColorIO config",
                                        largestConfig),
                        std::filesystem::absolute(name).parent_path());
        else if (libraryVersion() >= ConfigVersion{2, 2})
            impl->config = archived(name);
        else
            throw inputError(
                "the OpenColorIO config {} needs OpenColorIO 2.2; this build has {}: name a "
                "config.ocio file instead",
                impl->origin, OCIO::GetVersion());
        impl->files = checkConfigGraph(*impl->config, impl->origin);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // OpenColorIO's, of its YAML, and of its numbers
        throw inputError("the OpenColorIO config {} cannot be used: {}", impl->origin, e.what());
    }
    if (!name.empty()) impl->files.emplace_back(name);
    if (!impl->config->hasRole(OCIO::ROLE_SCENE_LINEAR) ||
        !impl->config->getColorSpace(OCIO::ROLE_SCENE_LINEAR))
        throw inputError(
            "the OpenColorIO config {} has no role 'scene_linear', which names the colour space to "
            "render in",
            impl->origin);
    return impl;
}

const std::vector<std::filesystem::path>& ColorConfig::files() const { return impl_->files; }

const std::string& ColorConfig::note() const { return impl_->note; }

std::optional<Chromaticities> ColorConfig::chromaticities() const {
    const auto space = impl_->config->getColorSpace(OCIO::ROLE_SCENE_LINEAR);
    std::optional<Chromaticities> found = chromaticitiesFromName(space->getName());
    for (size_t i = 0; !found && i < space->getNumAliases(); ++i)
        found = chromaticitiesFromName(space->getAlias(i));
    return found;
}

std::string ColorConfig::interopId() const {
#if OCIO_VERSION_HEX >= 0x02050000
    const auto space = impl_->config->getColorSpace(OCIO::ROLE_SCENE_LINEAR);
    if (const std::string id = space->getInteropID(); !id.empty()) return id;
#endif
    const auto known = chromaticities();
    return known ? interopIdOf(*known) : "";
}

DisplayTransform ColorConfig::displayTransform(const DisplaySettings& settings) const {
    const DisplaySettings chosen = impl_->complete(settings);
    try {
        const auto cpu = pipeline(chosen)->getProcessor(impl_->config)->getDefaultCPUProcessor();
        return DisplayTransform(
            std::make_shared<DisplayTransform::Processor>(DisplayTransform::Processor{cpu}));
    } catch (const std::exception& e) {
        throw impl_->cannotShow(chosen, e.what());
    }
}

void ColorConfig::toSceneLinear(std::span<float> rgb, const std::string& space) const {
    const OCIO::Config& config = *impl_->config;
    if (!config.getColorSpace(space.c_str()))
        throw inputError("colour space '{}' not found in the OpenColorIO config {}; it has: {}",
                         space, impl_->origin, joinNames(spaceNames(config)));
    try {
        const auto cpu =
            config.getProcessor(space.c_str(), OCIO::ROLE_SCENE_LINEAR)->getDefaultCPUProcessor();
        OCIO::PackedImageDesc pixels(rgb.data(), static_cast<long>(rgb.size() / 3), 1, 3);
        if (!rgb.empty()) cpu->apply(pixels);
    } catch (const std::exception& e) {
        throw inputError("the OpenColorIO config {} cannot convert from colour space '{}': {}",
                         impl_->origin, space, e.what());
    }
}

std::string ColorConfig::pictureSpace() const {
    // Woodcock's own config, ACES 1.3 and later (its alias and its name), ACES 1.2 and before,
    // later OpenColorIO's built-in ones, Blender.
    for (const char* name : {"sRGB texture", "srgb_tx", "sRGB - Texture",
                             "Utility - sRGB - Texture", "sRGB Encoded Rec.709 (sRGB)", "sRGB"})
        if (const auto space = impl_->config->getColorSpace(name)) return space->getName();
    return {};
}

std::vector<std::string> ColorConfig::views(const std::string& display) const {
    DisplaySettings settings;
    settings.display = display;
    return viewNames(*impl_->config, impl_->complete(settings).display);
}

}  // namespace woodcock::image
