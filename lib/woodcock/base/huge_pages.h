// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace woodcock {

/// Asks the system to back an array by huge pages (2 MiB on most machines), so that random reads of
/// it miss the processor's table of pages less often. To be called before the memory is first
/// written. A mere wish: it does nothing for small arrays, on systems that know no such wish, and
/// where the system decides by itself. Linux leaves it to programs where
/// /sys/kernel/mm/transparent_hugepage/enabled says madvise.
void wishHugePages(void* data, std::size_t bytes);

/// An array of values that are not set yet, in huge pages where it is large.
template <class T>
std::unique_ptr<T[]> largeArray(std::size_t count) {
    std::unique_ptr<T[]> values = std::make_unique_for_overwrite<T[]>(count);
    wishHugePages(values.get(), count * sizeof(T));
    return values;
}

/// Makes room for `count` elements, in huge pages where that is much.
template <class T>
void reserveLarge(std::vector<T>& values, std::size_t count) {
    if (count <= values.capacity()) return;
    values.reserve(count);
    const std::size_t used = values.size();
    wishHugePages(values.data() + used, (values.capacity() - used) * sizeof(T));
}

/// Frees the room that an array does not use. What is left stays in huge pages where it is large.
template <class T>
void shrinkLarge(std::vector<T>& values) {
    if (values.size() == values.capacity()) return;
    std::vector<T> fitting;
    reserveLarge(fitting, values.size());
    fitting.assign(values.begin(), values.end());
    values = std::move(fitting);
}

}  // namespace woodcock
