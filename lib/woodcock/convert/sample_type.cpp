// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/sample_type.h"

#include <array>
#include <utility>

#include "woodcock/base/nearest_name.h"

namespace woodcock::convert {

namespace {

constexpr std::array<std::pair<const char*, SampleType>, 11> types{{{"u8", SampleType::U8},
                                                                    {"i8", SampleType::I8},
                                                                    {"u16", SampleType::U16},
                                                                    {"i16", SampleType::I16},
                                                                    {"u32", SampleType::U32},
                                                                    {"i32", SampleType::I32},
                                                                    {"u64", SampleType::U64},
                                                                    {"i64", SampleType::I64},
                                                                    {"f16", SampleType::F16},
                                                                    {"f32", SampleType::F32},
                                                                    {"f64", SampleType::F64}}};

}  // namespace

std::size_t sampleBytes(SampleType type) {
    return withSampleType(type, [](auto value) { return sizeof value; });
}

const char* sampleTypeName(SampleType type) {
    for (const auto& [name, known] : types)
        if (known == type) return name;
    return "";
}

std::vector<std::string> sampleTypeNames() {
    std::vector<std::string> names;
    for (const auto& [name, type] : types) names.emplace_back(name);
    return names;
}

SampleType sampleTypeFromName(std::string_view name) {
    for (const auto& [known, type] : types)
        if (name == known) return type;
    throw usageError("'{}' is not a type of numbers{}", name,
                     suggestName(name, "known", sampleTypeNames()));
}

bool fitsFloat(SampleType type) { return type == SampleType::F32 || sampleBytes(type) < 4; }

}  // namespace woodcock::convert
