// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <unordered_map>
#include <vector>

#include "woodcock/bake/openvdb_ax_bounds.h"

namespace woodcock::bake {
namespace {

namespace ast = openvdb::ax::ast;
using ast::tokens::CoreType;

/// Names with a space, which no user's code can have.
constexpr const char* roundsLeft = "rounds left";

ast::Expression* roundsLeftVariable() { return new ast::Local(roundsLeft); }

/// rounds left-- > 0 || (overrun = 1, false)
ast::Expression* anotherRound() {
    auto* const count = new ast::Crement(roundsLeftVariable(), ast::Crement::Decrement, true);
    auto* const some =
        new ast::BinaryOperator(count, new ast::Value<std::int32_t>(0), ast::tokens::MORETHAN);
    auto* const tell =
        new ast::AssignExpression(new ast::ExternalVariable(axOverrunVariable, CoreType::VEC3F),
                                  new ast::Value<std::int32_t>(1));
    auto* const none =
        new ast::CommaOperator(std::vector<ast::Expression*>{tell, new ast::Value<bool>(false)});
    return new ast::BinaryOperator(some, none, ast::tokens::OR);
}

class Bounds {
public:
    Bounds(const std::function<AxLocation(const ast::Node&)>& locate, openvdb::ax::Logger& logger)
        : locate_(locate), logger_(logger) {}

    std::shared_ptr<const ast::Tree> of(const ast::Tree& code) {
        const std::unique_ptr<ast::Tree> copy(code.copy());
        copyLocations(code, *copy);
        change(*copy);
        const ast::Block& statements = *copy->child(0);

        auto* const block = new ast::Block();
        block->addStatement(new ast::ConditionalStatement(
            new ast::ExternalVariable(axStopVariable, CoreType::FLOAT),
            new ast::Block(new ast::Keyword(ast::tokens::RETURN))));
        if (hasLoops_)
            block->addStatement(
                new ast::DeclareLocal(CoreType::INT32, new ast::Local(roundsLeft),
                                      new ast::Value<std::int32_t>(std::uint64_t{mostAxRounds})));
        for (std::size_t i = 0; i < casts_.size(); ++i)
            block->addStatement(new ast::DeclareLocal(casts_[i], new ast::Local(castName(i))));
        for (std::size_t i = 0; i < statements.children(); ++i)
            block->addStatement(copyWithLocations(*statements.child(i)));
        auto tree = std::make_shared<ast::Tree>(block);
        logger_.setSourceTree(tree);
        tellLocations(*tree);
        return tree;
    }

private:
    static std::string castName(std::size_t i) { return fmt::format("cast {}", i); }

    /// Replaces below the node. Children come first, as a replacement is made of copies.
    void change(ast::Node& node) {
        for (std::size_t i = 0; i < node.children(); ++i) {
            // The tree is our own; AX returns its children as constants.
            auto* const child = const_cast<ast::Node*>(node.child(i));
            if (!child) continue;
            change(*child);
            if (child->nodetype() == ast::Node::CastNode)
                replace(node, i, withoutCast(static_cast<const ast::Cast&>(*child)), *child);
        }
        if (node.nodetype() == ast::Node::LoopNode) boundLoop(static_cast<ast::Loop&>(node));
    }

    ast::Expression* withoutCast(const ast::Cast& cast) {
        casts_.push_back(cast.type());
        return new ast::AssignExpression(new ast::Local(castName(casts_.size() - 1)),
                                         copyWithLocations(*cast.expression()));
    }

    void boundLoop(ast::Loop& loop) {
        const auto* const condition = dynamic_cast<const ast::Expression*>(loop.condition());
        if (!condition) {
            logger_.error(
                "a loop's condition must not declare a variable; declare it before the loop",
                location(*loop.condition()));
            return;
        }
        hasLoops_ = true;
        replace(loop, 0,
                new ast::BinaryOperator(anotherRound(), copyWithLocations(*condition),
                                        ast::tokens::AND),
                *condition);
    }

    void replace(ast::Node& parent, std::size_t i, ast::Expression* replacement,
                 const ast::Node& original) {
        const AxLocation place = location(original);
        locations_[replacement] = place;
        if (parent.replacechild(i, replacement)) {
            replacement->setParent(&parent);  // OpenVDB AX 10 forgets it in a loop's iteration
            return;
        }
        delete replacement;
        logger_.error("this is not possible here; assign it to a variable first", place);
    }

    AxLocation location(const ast::Node& node) const {
        const auto found = locations_.find(&node);
        return found == locations_.end() ? AxLocation(0, 0) : found->second;
    }

    template <class T>
    T* copyWithLocations(const T& node) {
        auto* const copy = static_cast<T*>(node.copy());
        copyLocations(node, *copy);
        return copy;
    }

    void copyLocations(const ast::Node& from, const ast::Node& to) {
        const auto known = locations_.find(&from);
        locations_[&to] = known == locations_.end() ? locate_(from) : known->second;
        for (std::size_t i = 0; i < from.children(); ++i)
            if (from.child(i)) copyLocations(*from.child(i), *to.child(i));
    }

    void tellLocations(const ast::Node& node) {
        logger_.addNodeLocation(&node, location(node));
        for (std::size_t i = 0; i < node.children(); ++i)
            if (node.child(i)) tellLocations(*node.child(i));
    }

    const std::function<AxLocation(const ast::Node&)>& locate_;
    openvdb::ax::Logger& logger_;
    std::unordered_map<const ast::Node*, AxLocation> locations_;
    std::vector<CoreType> casts_;  ///< the type of each
    bool hasLoops_ = false;
};

}  // namespace

std::shared_ptr<const ast::Tree> boundAx(const ast::Tree& code,
                                         const std::function<AxLocation(const ast::Node&)>& locate,
                                         openvdb::ax::Logger& logger) {
    return Bounds(locate, logger).of(code);
}

}  // namespace woodcock::bake
