// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <openvdb_ax/ast/Scanners.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "woodcock/bake/openvdb_ax_rules.h"

namespace woodcock::bake {
namespace {

namespace ast = openvdb::ax::ast;
using ast::tokens::CoreType;

bool isInteger(CoreType type) {
    switch (type) {
        case CoreType::FLOAT:
        case CoreType::VEC2F:
        case CoreType::VEC3F:
        case CoreType::VEC4F:
        case CoreType::DOUBLE:
        case CoreType::VEC2D:
        case CoreType::VEC3D:
        case CoreType::VEC4D:
        case CoreType::MAT3F:
        case CoreType::MAT3D:
        case CoreType::MAT4F:
        case CoreType::MAT4D:
        case CoreType::STRING:
            return false;
        default:
            return true;
    }
}

/// The number of values along one index, and along each of two for a matrix.
std::pair<std::uint64_t, std::uint64_t> components(CoreType type) {
    switch (type) {
        case CoreType::VEC2I:
        case CoreType::VEC2F:
        case CoreType::VEC2D:
            return {2, 0};
        case CoreType::VEC4I:
        case CoreType::VEC4F:
        case CoreType::VEC4D:
            return {4, 0};
        case CoreType::MAT3F:
        case CoreType::MAT3D:
            return {9, 3};
        case CoreType::MAT4F:
        case CoreType::MAT4D:
            return {16, 4};
        default:
            return {3, 0};
    }
}

/// The value of a literal, such as 2; absent for other expressions, such as 1 + 1.
std::optional<std::uint64_t> integerLiteral(const ast::Node& node) {
    switch (node.nodetype()) {
        case ast::Node::ValueInt16Node:
            return static_cast<const ast::Value<std::int16_t>&>(node).asContainerType();
        case ast::Node::ValueInt32Node:
            return static_cast<const ast::Value<std::int32_t>&>(node).asContainerType();
        case ast::Node::ValueInt64Node:
            return static_cast<const ast::Value<std::int64_t>&>(node).asContainerType();
        default:
            return {};
    }
}

/// Whether division by it is safe: a positive number that fits in 32 bits, or a vector of them.
/// (The least integer divided by -1 is as bad as division by 0, and what does not fit wraps.)
bool isSafeDivisor(const ast::Node& node) {
    if (node.nodetype() == ast::Node::ArrayPackNode) {
        for (std::size_t i = 0; i < node.children(); ++i)
            if (!isSafeDivisor(*node.child(i))) return false;
        return node.children() > 0;
    }
    const std::optional<std::uint64_t> value = integerLiteral(node);
    return value && *value > 0 && *value <= INT32_MAX;
}

/// The time to compile grows with the square of the depth, or faster.
constexpr int mostBlocks = 32;

const std::set<std::string> moduloFunctions{"euclideanmod", "floormod", "truncatemod"};

class Rules {
public:
    Rules(const ast::Tree& code,
          const std::function<void(const std::string&, const ast::Node&)>& report)
        : report_(report) {
        // By name only, whatever the scope: a variable may have any type that a variable of its
        // name has.
        ast::visitNodeType<ast::DeclareLocal>(code, [&](const ast::DeclareLocal& node) {
            types_[node.local()->name()].insert(node.type());
            return true;
        });
    }

    void check(const ast::Node& node, int blocks = 0) const {
        blocks += node.nodetype() == ast::Node::BlockNode;
        if (blocks > mostBlocks) {
            report_(fmt::format("more than {} nested blocks", mostBlocks), node);
            return;
        }
        switch (node.nodetype()) {
            case ast::Node::BinaryOperatorNode: {
                const auto& binary = static_cast<const ast::BinaryOperator&>(node);
                checkDivision(binary.operation(), *binary.lhs(), *binary.rhs(), node);
                checkShift(binary.operation(), *binary.rhs(), node);
                break;
            }
            case ast::Node::AssignExpressionNode: {
                const auto& assign = static_cast<const ast::AssignExpression&>(node);
                checkDivision(assign.operation(), *assign.lhs(), *assign.rhs(), node);
                checkShift(assign.operation(), *assign.rhs(), node);
                break;
            }
            case ast::Node::FunctionCallNode:
                checkCall(static_cast<const ast::FunctionCall&>(node));
                break;
            case ast::Node::ArrayUnpackNode:
                checkIndex(static_cast<const ast::ArrayUnpack&>(node));
                break;
            case ast::Node::ValueStrNode:
                report_("text has no use here; grids hold numbers", node);
                break;
            case ast::Node::DeclareLocalNode:
                if (static_cast<const ast::DeclareLocal&>(node).type() == CoreType::STRING)
                    report_("a text variable has no use here; grids hold numbers", node);
                break;
            case ast::Node::AttributeNode:
                if (static_cast<const ast::Attribute&>(node).type() == CoreType::STRING)
                    report_("text has no use here; grids hold numbers", node);
                break;
            case ast::Node::ExternalVariableNode:
                report_("a $variable has no value here; write a number", node);
                break;
            default:
                break;
        }
        for (std::size_t i = 0; i < node.children(); ++i)
            if (const ast::Node* child = node.child(i)) check(*child, blocks);
    }

private:
    void checkDivision(ast::tokens::OperatorToken operation, const ast::Node& lhs,
                       const ast::Node& rhs, const ast::Node& node) const {
        const bool divides = operation == ast::tokens::DIVIDE || operation == ast::tokens::MODULO ||
                             operation == ast::tokens::DIVIDEEQUALS ||
                             operation == ast::tokens::MODULOEQUALS;
        if (divides) checkDivision(lhs, rhs, node);
    }

    void checkDivision(const ast::Node& lhs, const ast::Node& rhs, const ast::Node& node) const {
        if (!mayBeInteger(lhs) || !mayBeInteger(rhs) || isSafeDivisor(rhs)) return;
        report_(
            "integers may be divided by positive constants only, as a division by 0 would end the "
            "program; otherwise make one of them a float: float(...)",
            node);
    }

    /// Neither processors nor LLVM define a shift by more bits than the number has.
    void checkShift(ast::tokens::OperatorToken operation, const ast::Node& rhs,
                    const ast::Node& node) const {
        const bool shifts =
            operation == ast::tokens::SHIFTLEFT || operation == ast::tokens::SHIFTRIGHT ||
            operation == ast::tokens::SHIFTLEFTEQUALS || operation == ast::tokens::SHIFTRIGHTEQUALS;
        const std::optional<std::uint64_t> bits = integerLiteral(rhs);
        if (shifts && !(bits && *bits < 32))
            report_("bits may be shifted by a constant from 0 to 31 only", node);
    }

    void checkCall(const ast::FunctionCall& call) const {
        const std::string& name = call.name();
        if ((name == "rand" || name == "rand32") && call.numArgs() == 0)
            report_(name + "() needs a seed; without it the value depends on threads", call);
        if (name == "external" || name == "externalv")
            report_(name + "() has no data to read here", call);
        if (name == "print") report_("print() is not possible here", call);
        if (moduloFunctions.contains(name) && call.numArgs() == 2)
            checkDivision(*call.child(0), *call.child(1), call);
    }

    void checkIndex(const ast::ArrayUnpack& node) const {
        // AX's grammar gives components to variables only.
        std::uint64_t size = 16;
        for (const CoreType type : types(*node.expression())) {
            const auto [all, side] = components(type);
            size = std::min(size, node.isMatrixIndex() ? side : all);
        }
        for (const ast::Expression* index : {node.component0(), node.component1()}) {
            if (!index) continue;
            const std::optional<std::uint64_t> value = integerLiteral(*index);
            if (value && *value < size) continue;
            report_(fmt::format("a component's index must be a number from 0 to {} here",
                                size == 0 ? 0 : size - 1),
                    node);
        }
    }

    /// Where it may be either, it counts as an integer.
    bool mayBeInteger(const ast::Node& node) const {
        switch (node.nodetype()) {
            case ast::Node::ValueFloatNode:
            case ast::Node::ValueDoubleNode:
            case ast::Node::ValueStrNode:
                return false;
            case ast::Node::AttributeNode:
            case ast::Node::LocalNode:
            case ast::Node::CastNode: {
                const std::set<CoreType> found = types(node);
                return std::any_of(found.begin(), found.end(), isInteger);
            }
            case ast::Node::ArrayUnpackNode:
                return mayBeInteger(*static_cast<const ast::ArrayUnpack&>(node).expression());
            case ast::Node::AssignExpressionNode:
                return mayBeInteger(*static_cast<const ast::AssignExpression&>(node).lhs());
            case ast::Node::CommaOperatorNode:
                return mayBeInteger(*node.child(node.children() - 1));
            case ast::Node::BinaryOperatorNode: {
                const auto& binary = static_cast<const ast::BinaryOperator&>(node);
                if (ast::tokens::operatorType(binary.operation()) != ast::tokens::ARITHMETIC)
                    return true;
                return mayBeInteger(*binary.lhs()) && mayBeInteger(*binary.rhs());
            }
            case ast::Node::ArrayPackNode:
                return allMayBeInteger(node);
            case ast::Node::FunctionCallNode:
                return callMayBeInteger(static_cast<const ast::FunctionCall&>(node));
            case ast::Node::TernaryOperatorNode: {
                const auto& ternary = static_cast<const ast::TernaryOperator&>(node);
                const ast::Expression* yes = ternary.hasTrue() ? ternary.trueBranch() : nullptr;
                return mayBeInteger(yes ? *yes : *ternary.condition()) &&
                       mayBeInteger(*ternary.falseBranch());
            }
            case ast::Node::UnaryOperatorNode: {
                const auto& unary = static_cast<const ast::UnaryOperator&>(node);
                return ast::tokens::operatorType(unary.operation()) != ast::tokens::ARITHMETIC ||
                       mayBeInteger(*unary.expression());
            }
            case ast::Node::CrementNode:
                return mayBeInteger(*static_cast<const ast::Crement&>(node).expression());
            default:
                return true;
        }
    }

    bool allMayBeInteger(const ast::Node& node) const {
        for (std::size_t i = 0; i < node.children(); ++i)
            if (!mayBeInteger(*node.child(i))) return false;
        return true;
    }

    bool callMayBeInteger(const ast::FunctionCall& call) const {
        static const std::set<std::string> integer{
            "argsort", "atoi",  "getcoord", "getcoordx", "getcoordy",      "getcoordz", "hash",
            "ingroup", "isnan", "isinf",    "isfinite",  "polardecompose", "sign",      "signbit"};
        static const std::set<std::string> likeItsArguments{"abs",      "clamp", "cross", "dot",
                                                            "lengthsq", "max",   "min",   "sort"};
        const std::string& name = call.name();
        if (likeItsArguments.contains(name) || moduloFunctions.contains(name))
            return allMayBeInteger(call);
        return integer.contains(name);
    }

    std::set<CoreType> types(const ast::Node& node) const {
        if (node.nodetype() == ast::Node::AttributeNode)
            return {static_cast<const ast::Attribute&>(node).type()};
        if (node.nodetype() == ast::Node::CastNode)
            return {static_cast<const ast::Cast&>(node).type()};
        if (node.nodetype() != ast::Node::LocalNode) return {};
        const auto found = types_.find(static_cast<const ast::Local&>(node).name());
        return found == types_.end() ? std::set<CoreType>{} : found->second;
    }

    const std::function<void(const std::string&, const ast::Node&)>& report_;
    std::map<std::string, std::set<CoreType>> types_;
};

}  // namespace

void checkAxRules(const ast::Tree& code,
                  const std::function<void(const std::string&, const ast::Node&)>& report) {
    Rules(code, report).check(code);
}

}  // namespace woodcock::bake
