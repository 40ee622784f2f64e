// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/film_state.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <system_error>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/regular_file.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_header.h"

namespace woodcock::image {

const char* const stateName = "woodcock.sums";

namespace {

static_assert(std::endian::native == std::endian::little, "halves of numbers are taken in place");

constexpr std::string_view factPrefix = "woodcock/";
constexpr const char* planesFact = "planes";
constexpr const char* checkFact = "check";

/// Numbers of a pixel of a plane, wherever they are.
template <typename Plane>
auto* wordsOf(const Plane& plane) {
    using Sum = std::remove_reference_t<decltype(*plane.sums)>;
    using Byte = std::conditional_t<std::is_const_v<Sum>, const char, char>;
    return plane.sums ? reinterpret_cast<Byte*>(plane.sums) : reinterpret_cast<Byte*>(plane.counts);
}

/// Calls act(word) for all numbers of a plane, as integers.
template <typename Plane, typename Act>
void eachWord(const Plane& plane, std::size_t pixels, Act act) {
    const char* const first = wordsOf(plane);
    for (std::size_t p = 0; p < pixels; ++p)
        for (int c = 0; c < plane.components; ++c) {
            std::uint64_t word = 0;
            std::memcpy(&word,
                        first + (p * plane.stride + static_cast<std::size_t>(c)) * sizeof word,
                        sizeof word);
            act(word);
        }
}

/// Its numbers, each of which is a plane by itself.
template <typename Plane>
std::vector<Plane> componentsOf(const Plane& plane) {
    std::vector<Plane> components;
    for (int c = 0; c < plane.components; ++c)
        components.push_back({fmt::format("{}.{}", plane.name, c), 1, plane.stride,
                              plane.sums ? plane.sums + c : nullptr,
                              plane.counts ? plane.counts + c : nullptr});
    return components;
}

bool isZero(const Film::ConstPlane& component, std::size_t pixels) {
    for (std::size_t p = 0; p < pixels; ++p) {
        std::uint64_t word = 0;
        std::memcpy(&word, wordsOf(component) + p * component.stride * sizeof word, sizeof word);
        if (word != 0) return false;
    }
    return true;
}

std::size_t pixelsOf(const Film::Window& window) {
    return static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
}

/// FNV-1a with words in place of bytes, and the upper half brought down: multiplying moves bits up
/// alone.
class Check {
public:
    void add(std::uint64_t word) {
        hash_ = (hash_ ^ word) * 0x100000001b3;
        hash_ ^= hash_ >> 32;
    }
    void add(std::string_view text) {
        for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
        add(~std::uint64_t{0});
    }
    std::string text() const { return fmt::format("{:016x}", hash_); }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325;
};

template <typename Plane>
std::string checkOf(const StateFacts& facts, std::span<const Plane> planes,
                    const Film::Window& window) {
    Check check;
    for (const auto& [name, value] : facts)
        if (name != checkFact) check.add(name), check.add(value);
    for (const Plane& plane : planes)
        eachWord(plane, pixelsOf(window), [&](std::uint64_t word) { check.add(word); });
    return check.text();
}

/// Calls act(name of the channel, where its numbers begin).
template <typename Plane, typename Act>
void eachChannel(const Plane& component, Act act) {
    act(component.name + ".lo", wordsOf(component));
    act(component.name + ".hi", wordsOf(component) + 4);
}

/// Its numbers in place, without a copy.
template <typename Plane>
void insert(Imf::FrameBuffer& buffer, const Plane& component, const Film::Window& window) {
    const std::size_t ofPixel = component.stride * 8,
                      ofRow = ofPixel * static_cast<std::size_t>(window.width());
    const std::ptrdiff_t origin = static_cast<std::ptrdiff_t>(ofPixel) * window.x0 +
                                  static_cast<std::ptrdiff_t>(ofRow) * window.y0;
    eachChannel(component, [&](const std::string& name, const char* numbers) {
        // OpenEXR only reads from slices that it writes to files.
        buffer.insert(name,
                      Imf::Slice(Imf::UINT, const_cast<char*>(numbers) - origin, ofPixel, ofRow));
    });
}

class InMemory : public Imf::IStream {
public:
    explicit InMemory(std::span<const unsigned char> bytes)
        : Imf::IStream("memory"), bytes_(bytes) {}
    bool read(char to[], int n) override {
        if (static_cast<std::size_t>(n) > bytes_.size() - at_)
            throw std::runtime_error("the picture ends early");
        std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(n));
        at_ += static_cast<std::size_t>(n);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t to) override { at_ = std::min<std::size_t>(to, bytes_.size()); }

private:
    std::span<const unsigned char> bytes_;
    std::size_t at_ = 0;
};

/// Remembers what goes wrong: OpenEXR ends a file in a destructor, which cannot tell.
class OnDisk : public Imf::OStream {
public:
    explicit OnDisk(const std::filesystem::path& file)
        : Imf::OStream(file.c_str()), descriptor_(::open(file.c_str(), O_WRONLY | O_CLOEXEC)) {
        if (descriptor_ < 0) error_ = errno;
    }
    ~OnDisk() override { close(); }
    OnDisk(const OnDisk&) = delete;
    OnDisk& operator=(const OnDisk&) = delete;

    void write(const char from[], int n) override {
        for (int done = 0; done < n && !error_;) {
            const ssize_t now =
                ::pwrite(descriptor_, from + done, static_cast<std::size_t>(n - done),
                         static_cast<off_t>(at_));
            if (now < 0 && errno == EINTR) continue;
            if (now <= 0) error_ = now < 0 ? errno : ENOSPC;
            if (now > 0) done += static_cast<int>(now), at_ += static_cast<std::uint64_t>(now);
        }
        if (error_) throw std::system_error(error_, std::generic_category());
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t to) override { at_ = to; }

    /// The first error; 0: none. Some file systems report a full disk only here.
    int close() {
        if (descriptor_ >= 0 && ::close(descriptor_) != 0 && !error_) error_ = errno;
        descriptor_ = -1;
        return error_;
    }

private:
    int descriptor_, error_ = 0;
    std::uint64_t at_ = 0;
};

Imf::Header headerOf(const FilmState& state, std::span<const Film::ConstPlane> components,
                     const StateFacts& facts, const Imf::Header& picture) {
    const Film::Window& w = state.window;
    Imf::Header header(picture.displayWindow(),
                       IMATH_NAMESPACE::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}));
    header.setName(stateName);
    header.setType(Imf::SCANLINEIMAGE);
    // The lower bits of sums are noise, which nothing packs; but whole regions may be zero.
    header.compression() = Imf::RLE_COMPRESSION;
    for (const Film::ConstPlane& component : components)
        eachChannel(component, [&](const std::string& name, const char*) {
            header.channels().insert(name, Imf::Channel(Imf::UINT));
        });
    for (const auto& [name, value] : facts)
        header.insert(std::string(factPrefix) + name, Imf::StringAttribute(value));
    // OpenEXR demands that all parts agree in these.
    header.pixelAspectRatio() = picture.pixelAspectRatio();
    for (const char* shared : {"chromaticities", "timeCode"})
        if (const auto found = picture.find(shared); found != picture.end())
            header.insert(shared, found.attribute());
    return header;
}

void encode(OnDisk& to, std::span<const unsigned char> picture, const FilmState& state) {
    InMemory memory(picture);
    Imf::MultiPartInputFile from(memory);
    std::vector<Imf::Header> headers;
    for (int i = 0; i < from.parts(); ++i) {
        headers.push_back(from.header(i));
        if (!headers.back().hasName()) headers.back().setName("rgba");
        if (!headers.back().hasType()) headers.back().setType(Imf::SCANLINEIMAGE);
    }
    StateFacts facts = state.facts;
    std::string& names = facts[planesFact];
    std::vector<Film::ConstPlane> kept;
    for (const Film::ConstPlane& plane : state.planes) {
        names += (names.empty() ? "" : " ") + plane.name;
        for (Film::ConstPlane& component : componentsOf(plane))
            if (!isZero(component, pixelsOf(state.window))) kept.push_back(std::move(component));
    }
    // A part needs a channel.
    if (kept.empty()) kept.push_back(componentsOf(state.planes.front()).front());
    facts[checkFact] =
        checkOf(facts, std::span<const Film::ConstPlane>(state.planes), state.window);
    headers.push_back(headerOf(state, kept, facts, headers.front()));

    Imf::MultiPartOutputFile file(to, headers.data(), static_cast<int>(headers.size()));
    for (int i = 0; i < from.parts(); ++i) {
        Imf::InputPart in(from, i);
        Imf::OutputPart(file, i).copyPixels(in);
    }
    Imf::FrameBuffer buffer;
    for (const Film::ConstPlane& component : kept) insert(buffer, component, state.window);
    Imf::OutputPart sums(file, from.parts());
    sums.setFrameBuffer(buffer);
    sums.writePixels(state.window.height());
}

}  // namespace

void writeWithState(const std::filesystem::path& file, std::span<const unsigned char> picture,
                    const FilmState& state) {
    const auto failed = [&](const std::string& reason) {
        return failure("cannot write '{}': {}", file.string(), reason);
    };
    FileInTheMaking making(file);
    OnDisk to(making.temporary());
    try {
        encode(to, picture, state);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        if (const int error = to.close()) throw failed(std::generic_category().message(error));
        throw failed(e.what());
    }
    if (const int error = to.close()) throw failed(std::generic_category().message(error));
    making.commit();
}

namespace {

/// The part of the sums; -1: there is none.
int partOfState(const Imf::MultiPartInputFile& file) {
    for (int i = 0; i < file.parts(); ++i)
        if (file.header(i).hasName() && file.header(i).name() == stateName) return i;
    return -1;
}

std::vector<std::string> namesIn(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        if (end > at) words.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

}  // namespace

StateFile::StateFile(const std::filesystem::path& file, std::string_view what)
    : file_(file), what_(what) {
    const RegularFile bytes(file, what);
    if (checkImageHeader(bytes, file) != "openexr") throw unreadable("it is not an EXR file");
    try {
        const Imf::MultiPartInputFile input(file.c_str());
        part_ = partOfState(input);
        if (part_ < 0)
            throw unreadable(
                "it keeps no sums, only a picture. Checkpoints have them, and what is rendered "
                "with --samples, --tile or --mergeable");
        const Imf::Header& header = input.header(part_);
        const IMATH_NAMESPACE::Box2i whole = header.displayWindow(), data = header.dataWindow();
        if (whole.min.x != 0 || whole.min.y != 0)
            throw unreadable("its image does not begin at 0, 0, as those of woodcock do");
        width_ = whole.max.x - whole.min.x + 1, height_ = whole.max.y - whole.min.y + 1;
        window_ = {data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
        for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
            const std::string_view name = attribute.name();
            const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
            if (text && name.starts_with(factPrefix))
                facts_[std::string(name.substr(factPrefix.size()))] = text->value();
        }
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw unreadable(fmt::format("it is damaged ({})", e.what()));
    }
    if (window_.x0 < 0 || window_.y0 < 0 || window_.x1 > width_ || window_.y1 > height_)
        throw unreadable("it is damaged: its pixels lie outside of its image");
    planes_ = namesIn(fact(planesFact));
}

Error StateFile::unreadable(const std::string& reason) const {
    return inputError("cannot read {} '{}': {}", what_, file_.string(), reason);
}

const std::string& StateFile::fact(const std::string& name) const {
    const auto found = facts_.find(name);
    if (found == facts_.end())
        throw unreadable(
            fmt::format("it does not tell its '{}'; another version of woodcock may "
                        "have written it",
                        name));
    return found->second;
}

std::int64_t StateFile::count(const std::string& name, std::int64_t lowest,
                              std::int64_t highest) const {
    const std::string& text = fact(name);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < lowest ||
        value > highest)
        throw unreadable(fmt::format("its '{}' is '{}', not a number from {} to {}", name,
                                     shown(text, 40), lowest, highest));
    return value;
}

double StateFile::number(const std::string& name) const {
    const std::string& text = fact(name);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw unreadable(fmt::format("its '{}' is '{}', not a number", name, shown(text, 40)));
    return value;
}

template <typename Number>
std::vector<Number> StateFile::numbers(const std::string& name, std::size_t many) const {
    const std::string& text = fact(name);
    std::vector<Number> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end && numbers.size() <= many) {
        Number value{};
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || (next < end && *next != ',')) break;
        numbers.push_back(value);
        at = next < end ? next + 1 : next;
    }
    if (at != end || numbers.size() != many)
        throw unreadable(
            fmt::format("its '{}' is '{}', not {} numbers", name, shown(text, 60), many));
    return numbers;
}

template std::vector<int> StateFile::numbers(const std::string&, std::size_t) const;
template std::vector<float> StateFile::numbers(const std::string&, std::size_t) const;
template std::vector<std::uint64_t> StateFile::numbers(const std::string&, std::size_t) const;

void StateFile::read(std::span<const Film::Plane> planes) const {
    try {
        Imf::MultiPartInputFile input(file_.c_str());
        const Imf::ChannelList& channels = input.header(part_).channels();
        Imf::FrameBuffer buffer;
        for (const Film::Plane& plane : planes)
            for (const Film::Plane& component : componentsOf(plane)) {
                bool there = false;
                eachChannel(component, [&](const std::string& name, const char*) {
                    there |= channels.findChannel(name) != nullptr;
                });
                if (there) insert(buffer, component, window_);
            }
        Imf::InputPart part(input, part_);
        part.setFrameBuffer(buffer);
        part.readPixels(window_.y0, window_.y1 - 1);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw unreadable(fmt::format("it is damaged ({})", e.what()));
    }
    if (checkOf(facts_, planes, window_) != fact(checkFact))
        throw unreadable("it is damaged: its sums are not those that were written");
}

}  // namespace woodcock::image
