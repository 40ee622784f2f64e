// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <any>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace woodcock::scene {

/// The name of what was loaded from a file, in one of several ways.
template <class... How>
std::string cacheName(std::string_view kind, const std::string& file, const How&... how) {
    [[maybe_unused]] const auto text = [](const auto& part) {
        if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(part)>>)
            return fmt::format("\n{}", static_cast<int>(part));
        else
            return fmt::format("\n{}", part);
    };
    return (fmt::format("{}\n{}", kind, file) + ... + text(how));
}

/// What was loaded, by a name that says from which file and how. Scenes that are loaded one after
/// the other with one cache, as the frames of a sequence are, load what they share once. For one
/// thread at a time.
class LoadCache {
public:
    /// What is kept under `name`: made by make() where nothing is. It stays valid until
    /// forgetUnused(). `name` determines its type.
    template <class T, class Make>
    const T& get(const std::string& name, Make make) {
        const auto known = entries_.find(name);
        if (known == entries_.end()) {
            T made = make();  // which may ask the cache in turn, and throw
            Entry& entry = entries_[name];
            entry.value = std::move(made);
            return *std::any_cast<T>(&entry.value);
        }
        known->second.used = true;
        return *std::any_cast<T>(&known->second.value);
    }

    /// Drops what get() was not asked for since the last call.
    void forgetUnused() {
        for (auto entry = entries_.begin(); entry != entries_.end();)
            entry =
                std::exchange(entry->second.used, false) ? std::next(entry) : entries_.erase(entry);
    }

private:
    struct Entry {
        std::any value;
        bool used = true;
    };
    std::map<std::string, Entry> entries_;
};

}  // namespace woodcock::scene
