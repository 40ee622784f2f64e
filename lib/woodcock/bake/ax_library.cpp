// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>
#include <openvdb/openvdb.h>  // without the library, which the module does not link
#include <openvdb_ax/ast/AST.h>
#include <openvdb_ax/ast/Parse.h>
#include <openvdb_ax/ast/Scanners.h>
#include <openvdb_ax/ax.h>
#include <openvdb_ax/compiler/AttributeRegistry.h>
#include <openvdb_ax/compiler/Compiler.h>
#include <openvdb_ax/compiler/CustomData.h>
#include <openvdb_ax/compiler/Logger.h>
#include <openvdb_ax/compiler/VolumeExecutable.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "woodcock/bake/openvdb_ax_bounds.h"
#include "woodcock/bake/openvdb_ax_program.h"
#include "woodcock/bake/openvdb_ax_rules.h"
#include "woodcock/base/error.h"

namespace woodcock::bake {
namespace {

namespace ax = openvdb::ax;
using ax::ast::tokens::CoreType;
using Streaming = ax::VolumeExecutable::Streaming;

/// AX walks the code's tree by recursion: this limit keeps it well inside a stack of 8 MiB.
constexpr std::size_t longestCode = 16384;

/// AX's own messages, with line and column first: "AX 2:14: unexpected SEMICOLON".
class Messages {
public:
    Messages() {
        logger.setErrorPrefix("");
        logger.setNumberedOutput(false);
    }
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    bool empty() const { return found_.empty(); }
    std::string text() const { return fmt::format("{}", fmt::join(found_, "; ")); }

    /// The line and column of a node of the code that was parsed with this logger.
    std::string placeOf(const ax::ast::Node& node) {
        std::vector<std::string> before;
        before.swap(found_);
        logger.error("", &node);
        before.swap(found_);
        return before.empty() ? "AX" : before.front().substr(0, before.front().find(": "));
    }

    AxLocation locationOf(const ax::ast::Node& node) {
        const std::string place = placeOf(node);  // "AX 2:14"
        const std::size_t digits = place.find_first_of("0123456789");
        AxLocation found(0, 0);
        if (digits == std::string::npos) return found;
        const char* const end = place.data() + place.size();
        const auto line = std::from_chars(place.data() + digits, end, found.first);
        if (line.ptr != end) std::from_chars(line.ptr + 1, end, found.second);
        return found;
    }

    ax::Logger logger{
        [this](const std::string& message) { found_.push_back(placeFirst(message)); }};

private:
    /// AX writes "message 2:14", and "message: 2:14" at times.
    static std::string placeFirst(const std::string& message) {
        const std::size_t space = message.rfind(' ');
        if (space == std::string::npos) return "AX: " + message;
        const std::string place = message.substr(space + 1);
        if (place.find(':') == std::string::npos ||
            place.find_first_not_of("0123456789:") != std::string::npos)
            return "AX: " + message;
        std::string what = message.substr(0, space);
        if (what.ends_with(':')) what.pop_back();
        // The rest of the parser's "memory exhausted", from which AX cuts off "syntax error, ".
        if (what == "ed") what = "nested too deeply";
        return fmt::format("AX {}: {}", place, what);
    }

    std::vector<std::string> found_;
};

/// A grid's name in the code.
struct Access {
    std::string name;
    CoreType type;
    bool writes;
    std::string place;
};

std::string typeName(CoreType type) { return ax::ast::tokens::typeStringFromToken(type); }

std::string accessName(const openvdb::GridBase& grid) {
    const CoreType type = ax::ast::tokens::tokenFromTypeString(grid.valueType());
    const std::string known = type == CoreType::UNKNOWN ? grid.valueType() : typeName(type);
    return known + "@" + grid.getName();
}

openvdb::GridBase& gridOf(const Access& access, const openvdb::GridPtrVec& grids,
                          const std::string& name) {
    std::vector<std::string> existing;
    for (const openvdb::GridBase::Ptr& grid : grids) {
        const CoreType type = ax::ast::tokens::tokenFromTypeString(grid->valueType());
        if (grid->getName() == access.name && type == access.type) return *grid;
        existing.push_back(accessName(*grid));
    }
    throw inputError("{}: {}: there is no grid {}@{}; there is {}", name, access.place,
                     typeName(access.type), access.name,
                     existing.empty() ? "none" : fmt::format("{}", fmt::join(existing, ", ")));
}

/// Turns active tiles of the root, 4096 voxels wide, into nodes of equal tiles one level below.
/// OpenVDB AX 10 takes the first of a root tile's parts for all of them where only some change.
void splitRootTiles(openvdb::GridBase& grid) {
    using Types =
        openvdb::NumericGridTypes::Append<openvdb::Vec3GridTypes>::Append<openvdb::BoolGrid>;
    grid.apply<Types>([](auto& typed) {
        auto& root = typed.tree().root();
        using Node = typename std::decay_t<decltype(root)>::ChildNodeType;
        std::vector<Node*> nodes;
        for (auto tile = root.beginValueOn(); tile; ++tile)
            nodes.push_back(new Node(tile.getCoord(), tile.getValue(), true));
        for (Node* node : nodes) root.addChild(node);
    });
}

/// Checks now and then, on a thread of its own, whether the running code should go on.
class Watch {
public:
    /// `look` returns whether it should; if not, `stop` is called once.
    Watch(std::function<bool()> look, std::function<void()> stop)
        : thread_([this, look = std::move(look), stop = std::move(stop)](
                      const std::stop_token& ended) { watch(ended, look, stop); }) {}

    /// Throws what `look` threw.
    void end() {
        thread_.request_stop();
        thread_.join();
        if (error_) std::rethrow_exception(error_);
    }

private:
    void watch(const std::stop_token& ended, const std::function<bool()>& look,
               const std::function<void()>& stop) {
        constexpr std::chrono::milliseconds pause(20);
        std::unique_lock lock(mutex_);
        while (!ended.stop_requested()) {
            wake_.wait_for(lock, ended, pause, [] { return false; });
            if (ended.stop_requested()) return;
            try {
                if (look()) continue;
            } catch (...) {
                error_ = std::current_exception();
            }
            return stop();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::exception_ptr error_;
    std::jthread thread_;
};

class Program : public AxProgram {
public:
    Program(const std::string& code, const std::string& name) : name_(name) {
        ax::initialize();
        if (code.size() > longestCode)
            throw inputError("{}: AX code of {} characters; it may have {}", name, code.size(),
                             longestCode);
        if (const std::size_t zero = code.find('\0'); zero != std::string::npos)
            throw inputError("{}: AX code with a null character, at {}", name, zero);
        Messages messages;
        const auto refuse = [&] {
            if (!messages.empty()) throw inputError("{}: {}", name, messages.text());
        };
        try {
            const ax::ast::Tree::ConstPtr tree = ax::ast::parse(code.c_str(), messages.logger);
            refuse();
            checkAxRules(*tree, [&](const std::string& message, const ax::ast::Node& node) {
                messages.logger.error(message, &node);
            });
            refuse();
            findAccesses(*tree, messages);
            const ax::ast::Tree::ConstPtr bounded = boundAx(
                *tree, [&](const ax::ast::Node& node) { return messages.locationOf(node); },
                messages.logger);
            refuse();
            executable_ =
                ax::Compiler().compile<ax::VolumeExecutable>(*bounded, messages.logger, controls_);
            refuse();
        } catch (const openvdb::Exception& error) {
            throw inputError("{}: AX: {}", name, error.what());
        }
        executable_->setCreateMissing(false);
        executable_->setValueIterator(ax::VolumeExecutable::IterType::ON);
        // AX keeps a tile where nothing in the code differs from voxel to voxel. That is right only
        // where the code reads nothing but the tile.
        if (accesses_.size() > 1 || executable_->getActiveTileStreaming() == Streaming::AUTO)
            executable_->setActiveTileStreaming(Streaming::ON);
    }

    bool run(openvdb::GridPtrVec& grids, const std::function<bool()>& goesOn) const override {
        std::vector<openvdb::GridBase*> written;
        for (const Access& access : accesses_) {
            openvdb::GridBase& grid = gridOf(access, grids, name_);
            if (access.writes) written.push_back(&grid);
        }
        if (executable_->getActiveTileStreaming() == Streaming::ON)
            for (openvdb::GridBase* grid : written) splitRootTiles(*grid);
        stop(false);
        clearOverrun();
        bool ended = false;
        Watch watch(
            [&] {
                if (hasOverrun()) return false;
                ended = goesOn && !goesOn();
                return !ended;
            },
            [&] { stop(true); });
        try {
            executable_->execute(grids);
        } catch (const openvdb::Exception& error) {
            throw inputError("{}: AX: {}", name_, error.what());
        }
        watch.end();
        if (hasOverrun())
            throw inputError(
                "{}: AX: its loops run more than {} rounds at one voxel; make them end earlier",
                name_, mostAxRounds);
        return !ended;
    }

private:
    void findAccesses(const ax::ast::Tree& tree, Messages& messages) {
        const auto registry = ax::AttributeRegistry::create(tree);
        for (const auto& access : registry->data()) {
            const auto token = ax::ast::Attribute::tokenFromNameType(access.name(), access.type());
            const ax::ast::Variable* use = ax::ast::firstUse(tree, token);
            accesses_.push_back({access.name(), access.type(), access.writes(),
                                 use ? messages.placeOf(*use) : "AX"});
        }
    }

    // The code reads one of these numbers and writes the other, on several threads.
    template <class T>
    T& control(const char* name) {
        return controls_->getOrInsertData<openvdb::TypedMetadata<T>>(name)->value();
    }
    void stop(bool on) const { std::atomic_ref(stop_).store(on ? 1.0F : 0.0F); }
    void clearOverrun() const { std::atomic_ref(overrun_.x()).store(0); }
    bool hasOverrun() const { return std::atomic_ref(overrun_.x()).load() != 0; }

    std::string name_;
    ax::CustomData::Ptr controls_ = ax::CustomData::create();
    float& stop_ = control<float>(axStopVariable);
    openvdb::Vec3s& overrun_ = control<openvdb::Vec3s>(axOverrunVariable);
    ax::VolumeExecutable::Ptr executable_;
    std::vector<Access> accesses_;
};

}  // namespace

extern "C" AxProgram* woodcockCompileAx(const std::string& code, const std::string& name) {
    return new Program(code, name);
}

}  // namespace woodcock::bake
