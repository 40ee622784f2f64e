// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace woodcock::grid {

/// Memory for a NanoVDB grid, aligned as its nodes must be. It is filled with zeros, where
/// NanoVDB's own buffer would write old memory into a file's gaps. NanoVDB's templates take it as a
/// buffer.
class NanoBuffer {
public:
    static constexpr std::size_t alignment = 32;

    static NanoBuffer create(std::uint64_t size, const NanoBuffer* = nullptr) {
        NanoBuffer buffer;
        buffer.blocks_.resize((size + alignment - 1) / alignment);
        buffer.size_ = size;
        return buffer;
    }
    std::uint8_t* data() { return blocks_.empty() ? nullptr : blocks_.data()->bytes; }
    const std::uint8_t* data() const { return blocks_.empty() ? nullptr : blocks_.data()->bytes; }
    std::uint64_t size() const { return size_; }
    void clear() { *this = {}; }

private:
    struct alignas(alignment) Block {
        std::uint8_t bytes[alignment] = {};
    };
    std::vector<Block> blocks_;
    std::uint64_t size_ = 0;
};

}  // namespace woodcock::grid
