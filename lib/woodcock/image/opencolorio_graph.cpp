// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/opencolorio_graph.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <utility>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/regular_file.h"

namespace OCIO = OCIO_NAMESPACE;

namespace woodcock::image {

namespace {

constexpr std::uint64_t largestTable = 1u << 30;
constexpr std::size_t deepest = 100;
constexpr double mostSteps = 100000;

/// Names of looks in an expression as "+a, -b | c".
std::vector<std::string> looksIn(const std::string& expression) {
    std::vector<std::string> names(1);
    for (const char c : expression) {
        if (c == ',' || c == '|' || c == ':')
            names.emplace_back();
        else if (c != '+' && c != '-')
            names.back() += c;
    }
    for (std::string& name : names) {
        name.erase(0, name.find_first_not_of(" \t"));
        name.erase(name.find_last_not_of(" \t") + 1);
    }
    std::erase(names, "");
    return names;
}

class GraphCheck {
public:
    GraphCheck(const OCIO::Config& config, const std::string& origin)
        : config_(config), origin_(origin), context_(config.getCurrentContext()) {}

    std::vector<std::filesystem::path> run() {
        for (int i = 0; i < spaces(); ++i)
            space(config_.getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL,
                                                   OCIO::COLORSPACE_ALL, i));
        for (int i = 0; i < config_.getNumLooks(); ++i) look(config_.getLookNameByIndex(i));
        for (int i = 0; i < config_.getNumViewTransforms(); ++i)
            viewTransform(config_.getViewTransformNameByIndex(i));
        for (int i = 0; i < config_.getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL); ++i)
            space(config_.getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, i));
        for (int i = 0; i < config_.getNumDisplaysAll(); ++i) {
            const char* const display = config_.getDisplayAll(i);
            for (const auto type : {OCIO::VIEW_DISPLAY_DEFINED, OCIO::VIEW_SHARED})
                for (int v = 0; v < config_.getNumViews(type, display); ++v)
                    view(display, config_.getView(type, display, v));
        }
        return {files_.begin(), files_.end()};
    }

private:
    int spaces() const {
        return config_.getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
    }
    std::string resolved(const char* text) const {
        return text && *text ? context_->resolveStringVar(text) : std::string();
    }

    /// Follows the references in `enter`, once for each name, and adds its steps to those of the
    /// referrer.
    template <class Enter>
    void follow(const std::string& kind, const std::string& name, Enter enter) {
        const std::string node = kind + " '" + shown(name, 100) + "'";
        if (const auto known = stepsOf_.find(node); known != stepsOf_.end())
            return count(known->second);
        if (const auto open = std::find(open_.begin(), open_.end(), node); open != open_.end()) {
            std::string circle;
            for (auto i = open; i != open_.end(); ++i) circle += *i + " -> ";
            throw refused("refers to itself: " + circle + node);
        }
        if (open_.size() == deepest)
            throw refused(fmt::format("has a chain of more than {1} references, from {0} on",
                                      open_.front(), deepest));
        open_.push_back(node);
        const double before = std::exchange(steps_, 1);
        enter();
        open_.pop_back();
        const double own = stepsOf_[node] = std::exchange(steps_, before);
        count(own);
    }
    void count(double steps) {
        steps_ += steps;
        if (!open_.empty() && steps_ > mostSteps)
            throw refused(
                fmt::format("takes more than {:.0f} steps for {}", mostSteps, open_.front()));
    }
    Error refused(const std::string& what) const {
        return inputError("the OpenColorIO config {} cannot be used: it {}", origin_, what);
    }

    /// Follows a colour space or a named transform: their names are one set.
    void space(const std::string& name) {
        if (const auto found = config_.getColorSpace(name.c_str()))
            follow("colour space", found->getName(), [&] {
                transform(found->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE));
                transform(found->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
            });
        else if (const auto named = config_.getNamedTransform(name.c_str()))
            follow("named transform", named->getName(), [&] {
                transform(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD));
                transform(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
            });
    }

    void look(const std::string& name) {
        const auto found = config_.getLook(name.c_str());
        if (!found) return;
        follow("look", found->getName(), [&] {
            space(resolved(found->getProcessSpace()));
            transform(found->getTransform());
            transform(found->getInverseTransform());
        });
    }

    void viewTransform(const std::string& name) {
        const auto found = config_.getViewTransform(name.c_str());
        if (!found) return;
        follow("view transform", found->getName(), [&] {
            transform(found->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
            transform(found->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE));
        });
    }

    void view(const std::string& display, const std::string& name) {
        follow("view", display + "/" + name, [&] {
            const auto words = [](const char* text) { return std::string(text ? text : ""); };
            const std::string to =
                words(config_.getDisplayViewColorSpaceName(display.c_str(), name.c_str()));
            space(to == OCIO::OCIO_VIEW_USE_DISPLAY_NAME ? display : to);
            viewTransform(
                words(config_.getDisplayViewTransformName(display.c_str(), name.c_str())));
            for (const std::string& l :
                 looksIn(words(config_.getDisplayViewLooks(display.c_str(), name.c_str()))))
                look(l);
        });
    }

    /// From one space to another, by the default view transform where they refer to different ones.
    void conversion(const std::string& from, const std::string& to) {
        if (from == to) return;  // nothing is done
        const auto a = config_.getColorSpace(from.c_str()), b = config_.getColorSpace(to.c_str());
        space(from);
        space(to);
        if (a && b && a->getReferenceSpaceType() != b->getReferenceSpaceType())
            if (const auto between = config_.getDefaultSceneToDisplayViewTransform())
                viewTransform(between->getName());
    }

    void transform(const OCIO::ConstTransformRcPtr& any) {
        if (!any) return;
        count(1);
        if (const auto group = OCIO::DynamicPtrCast<const OCIO::GroupTransform>(any)) {
            for (int i = 0; i < group->getNumTransforms(); ++i) transform(group->getTransform(i));
        } else if (const auto spaces = OCIO::DynamicPtrCast<const OCIO::ColorSpaceTransform>(any)) {
            conversion(resolved(spaces->getSrc()), resolved(spaces->getDst()));
        } else if (const auto looks = OCIO::DynamicPtrCast<const OCIO::LookTransform>(any)) {
            for (const std::string& name : looksIn(resolved(looks->getLooks()))) look(name);
            conversion(resolved(looks->getSrc()), resolved(looks->getDst()));
        } else if (const auto shows = OCIO::DynamicPtrCast<const OCIO::DisplayViewTransform>(any)) {
            space(resolved(shows->getSrc()));
            view(resolved(shows->getDisplay()), resolved(shows->getView()));
        } else if (const auto table = OCIO::DynamicPtrCast<const OCIO::FileTransform>(any)) {
            file(table->getSrc());
        }
    }

    /// A look-up table, or a list of transforms (.ctf, .clf) that may refer to others.
    void file(const char* name) {
        std::filesystem::path found;
        try {
            found = context_->resolveFileLocation(name);
        } catch (const OCIO::Exception&) {
            return;  // a view that needs it will report it
        }
        std::error_code ignored;
        if (!std::filesystem::exists(found, ignored)) return;
        follow("file", found.string(), [&] {
            const RegularFile open(found, "the OpenColorIO config's file");
            if (open.size() > largestTable)
                throw open.unreadable(
                    fmt::format("it has {} bytes, and {} are the most", open.size(), largestTable));
            files_.insert(found);
            if (found.extension() != ".ctf" && found.extension() != ".clf") return;
            constexpr std::size_t most = 64 << 20;
            const std::string text = open.read(0, most);
            static const std::regex reference(
                R"re(<Reference[^>]{0,1000}\bpath="([^"]{1,1000})")re");
            for (std::sregex_iterator i(text.begin(), text.end(), reference), end; i != end; ++i)
                file((*i)[1].str().c_str());
        });
    }

    const OCIO::Config& config_;
    const std::string& origin_;
    OCIO::ConstContextRcPtr context_;
    std::map<std::string, double> stepsOf_;
    std::vector<std::string> open_;  ///< the names being followed, outermost first
    std::set<std::filesystem::path> files_;
    double steps_ = 0;
};

}  // namespace

std::vector<std::filesystem::path> checkConfigGraph(const OCIO::Config& config,
                                                    const std::string& origin) {
    return GraphCheck(config, origin).run();
}

}  // namespace woodcock::image
