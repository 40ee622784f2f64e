// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/ply_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

#include "woodcock/base/error.h"
#include "woodcock/grid/input_file.h"

namespace woodcock::mesh {

namespace {

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

struct NamedType {
    std::string_view name;
    Type type;
};
constexpr NamedType namedTypes[]{
    {"char", Type::Int8},     {"int8", Type::Int8},     {"uchar", Type::Uint8},
    {"uint8", Type::Uint8},   {"short", Type::Int16},   {"int16", Type::Int16},
    {"ushort", Type::Uint16}, {"uint16", Type::Uint16}, {"int", Type::Int32},
    {"int32", Type::Int32},   {"uint", Type::Uint32},   {"uint32", Type::Uint32},
    {"float", Type::Float},   {"float32", Type::Float}, {"double", Type::Double},
    {"float64", Type::Double}};

constexpr std::size_t bytesOf(Type type) {
    constexpr std::size_t bytes[]{1, 1, 2, 2, 4, 4, 4, 8};
    return bytes[static_cast<std::size_t>(type)];
}

struct Shape {
    Type type{}, countType{};  // countType: of lists
};

class PlyReader {
public:
    explicit PlyReader(const std::filesystem::path& file)
        : file_(file), bytes_(grid::readInput(file)) {}

    std::vector<PlyElement> read() {
        readHeader();
        for (std::size_t i = 0; i < elements_.size(); ++i) readElement(elements_[i], shapes_[i]);
        return std::move(elements_);
    }

private:
    Error damaged(const std::string& what) const {
        return inputError("{} is cut short or damaged: {} at byte {}", file_.string(), what, at_);
    }

    std::string line() {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string::npos || end - at_ > 4096) throw damaged("a header without end");
        std::string text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (text.ends_with('\r')) text.pop_back();
        return text;
    }

    Type typeOf(const std::string& name) const {
        for (const NamedType& known : namedTypes)
            if (known.name == name) return known.type;
        throw damaged(fmt::format("a property of unknown type '{}'", name));
    }

    void readHeader() {
        if (!bytes_.starts_with("ply") || line() != "ply")
            throw inputError("{} is not a PLY file: it does not begin with 'ply'", file_.string());
        bool hasFormat = false;
        for (std::string text = line(); text != "end_header"; text = line()) {
            std::istringstream words(text);
            std::string word, name, type;
            words >> word;
            if (word == "format") {
                words >> type;
                hasFormat = true;
                ascii_ = type == "ascii";
                bigEndian_ = type == "binary_big_endian";
                if (!ascii_ && !bigEndian_ && type != "binary_little_endian")
                    throw damaged(fmt::format("unknown format '{}'", type));
            } else if (word == "element") {
                std::size_t count = 0;
                if (!(words >> name >> count) || name.empty()) throw damaged("an element");
                elements_.push_back({name, count, {}});
                shapes_.emplace_back();
            } else if (word == "property") {
                if (elements_.empty()) throw damaged("a property of no element");
                readProperty(words);
            } else if (word != "comment" && word != "obj_info" && !word.empty()) {
                throw damaged(fmt::format("'{}' in the header", word.substr(0, 40)));
            }
        }
        if (!hasFormat) throw damaged("a header without format");
    }

    void readProperty(std::istringstream& words) {
        std::string type, countType, name;
        words >> type;
        PlyElement::Property property;
        Shape shape;
        if (type == "list") {
            words >> countType >> type;
            property.isList = true;
            shape.countType = typeOf(countType);
        }
        shape.type = typeOf(type);
        if (!(words >> property.name)) throw damaged("a property without name");
        elements_.back().properties.push_back(std::move(property));
        shapes_.back().push_back(shape);
    }

    void readElement(PlyElement& element, const std::vector<Shape>& shapes) {
        // Each value takes a byte at least, or two as text.
        std::size_t least = 0;
        for (std::size_t i = 0; i < shapes.size(); ++i)
            least += ascii_ ? 1
                            : bytesOf(element.properties[i].isList ? shapes[i].countType
                                                                   : shapes[i].type);
        if (least == 0) {
            if (element.count > 0) throw damaged("an element without properties");
            return;
        }
        if (element.count > (bytes_.size() - at_) / least)
            throw damaged(fmt::format("{} of element '{}'", element.count, element.name));
        for (PlyElement::Property& property : element.properties)
            (property.isList ? (void)property.begins.reserve(element.count + 1)
                             : property.values.reserve(element.count));
        for (std::size_t n = 0; n < element.count; ++n)
            for (std::size_t i = 0; i < shapes.size(); ++i)
                readInto(element.properties[i], shapes[i]);
        for (PlyElement::Property& property : element.properties)
            if (property.isList) property.begins.push_back(property.values.size());
    }

    void readInto(PlyElement::Property& property, const Shape& shape) {
        double count = 1;
        if (property.isList) {
            property.begins.push_back(property.values.size());
            count = value(shape.countType);
            if (!(count >= 0) || count > static_cast<double>(bytes_.size() - at_))
                throw damaged(fmt::format("a list of {} values", count));
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            property.values.push_back(value(shape.type));
    }

    double value(Type type) { return ascii_ ? word() : number(type); }

    double word() {
        at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size());
        const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
        double v = 0;
        const auto [stop, error] = std::from_chars(bytes_.data() + at_, bytes_.data() + end, v);
        if (stop != bytes_.data() + end || stop == bytes_.data() + at_)
            throw damaged(fmt::format("'{}' instead of a number",
                                      bytes_.substr(at_, std::min<std::size_t>(end - at_, 40))));
        at_ = end;
        return v;
    }

    double number(Type type) {
        switch (type) {
            case Type::Int8:
                return as<std::int8_t>();
            case Type::Uint8:
                return as<std::uint8_t>();
            case Type::Int16:
                return as<std::int16_t>();
            case Type::Uint16:
                return as<std::uint16_t>();
            case Type::Int32:
                return as<std::int32_t>();
            case Type::Uint32:
                return as<std::uint32_t>();
            case Type::Float:
                return static_cast<double>(as<float>());
            case Type::Double:
                break;
        }
        return as<double>();
    }

    template <class T>
    T as() {
        if (bytes_.size() - at_ < sizeof(T)) throw damaged("its end");
        char bytes[sizeof(T)];
        std::memcpy(bytes, bytes_.data() + at_, sizeof(T));
        if (bigEndian_ == (std::endian::native == std::endian::little))
            std::reverse(bytes, bytes + sizeof(T));
        at_ += sizeof(T);
        T v;
        std::memcpy(&v, bytes, sizeof(T));
        return v;
    }

    std::filesystem::path file_;
    std::string bytes_;
    std::size_t at_ = 0;
    bool ascii_ = false, bigEndian_ = false;
    std::vector<PlyElement> elements_;
    std::vector<std::vector<Shape>> shapes_;
};

}  // namespace

const PlyElement::Property* PlyElement::find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view wanted : names)
        for (const Property& property : properties)
            if (property.name == wanted) return &property;
    return nullptr;
}

std::vector<PlyElement> readPly(const std::filesystem::path& file) {
    return PlyReader(file).read();
}

bool plyHasFaces(const std::filesystem::path& file) {
    for (const PlyElement& element : readPly(file))
        if (element.name == "face" && element.count > 0) return true;
    return false;
}

}  // namespace woodcock::mesh
