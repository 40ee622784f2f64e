// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "woodcock/light/sky_model.h"
#include "woodcock/scene/keys/light_keys.h"

namespace woodcock::scene {
namespace {

using Sky = SkyDescription;

Value<light::CalendarDate> date() {
    return {"date",
            {"2026-06-21", "2027-03-20"},
            [](const TomlValue& v, const std::filesystem::path&) {
                const std::string text = v.timeText("a date, such as 2026-06-21");
                const auto date = light::parseDate(text);
                if (!date)
                    throw v.error(
                        "is '{}', which the calendar does not have; give one such as "
                        "2026-06-21",
                        text);
                if (date->year < light::firstYear || date->year > light::lastYear)
                    throw v.error("is {}; the sun's place is known from {} to {}", text,
                                  light::firstYear, light::lastYear);
                return *date;
            },
            [](const light::CalendarDate& d, const SceneWriter&) { return light::dateText(d); }};
}

Value<double> timeOfDay() {
    return {"time of day",
            {"10:30:00", "14:00:00"},
            [](const TomlValue& v, const std::filesystem::path&) {
                const std::string text = v.timeText("a time of day, such as 14:30:00");
                const auto hours = light::parseTimeOfDay(text);
                if (!hours)
                    throw v.error(
                        "is '{}', which is no time of day; give one such as 14:30:00 or \"14:30\"",
                        text);
                return *hours;
            },
            [](const double& hours, const SceneWriter&) { return light::timeOfDayText(hours); }};
}

constexpr std::array momentKeys{"latitude", "longitude", "date", "time", "utc_offset"};

/// A key of the moment, which is there as soon as one of them is read. `part` of the moment: the
/// place or the time.
template <class Part, class M>
Key<Sky> momentKey(KeyInfo info, Part SkyMoment::*part, M Part::*member, Value<M> value) {
    info.beside =
        "latitude = 48\nlongitude = 11\ndate = 2026-06-01\ntime = 12:00:00\nutc_offset = 2";
    info.fallback = "none";
    info.always = true;
    return keyAt<Sky, M>(
        std::move(info),
        [=](auto& sky) {
            if constexpr (!std::is_const_v<std::remove_reference_t<decltype(sky)>>)
                if (!sky.moment) sky.moment.emplace();
            return sky.moment ? &(((*sky.moment).*part).*member) : nullptr;
        },
        std::move(value));
}

/// A key of the sun's place that is not written where a moment says it.
Key<Sky> sunKey(KeyInfo info, double SunPlace::*member, NumberRange range) {
    info.always = true;
    Key<Sky> k = key(std::move(info), &Sky::place, member, number(range));
    k.write = [write = k.write](const Sky& sky, const SceneWriter& out) {
        return sky.moment ? std::nullopt : write(sky, out);
    };
    return k;
}

std::vector<Key<Sky>> skyKeys() {
    constexpr NumberRange hazes{light::SkyModel::lowestTurbidity,
                                light::SkyModel::highestTurbidity};
    return {
        sunKey({.name = "elevation",
                .doc = "of the sun, in degrees above the horizon",
                .fallback = "that, or the five keys of a moment, must be given",
                .comment = "degrees above the horizon"},
               &SunPlace::elevation, {0, 90}),
        sunKey({.name = "azimuth",
                .doc = "of the sun, in degrees clockwise as seen from above: 0, north, is towards "
                       "-z (with `up = \"z\"`: +y), 90, east, towards +x",
                .comment = "degrees, clockwise from north"},
               &SunPlace::azimuth, {}),
        momentKey({.name = "latitude",
                   .doc = "instead of `elevation` and `azimuth`: degrees north of the equator"},
                  &SkyMoment::place, &light::EarthPlace::latitude, number({-90, 90})),
        momentKey({.name = "longitude", .doc = "degrees east of Greenwich"}, &SkyMoment::place,
                  &light::EarthPlace::longitude, number({-180, 180})),
        momentKey({.name = "date", .doc = "the day"}, &SkyMoment::time, &light::CivilTime::date,
                  date()),
        momentKey({.name = "time", .doc = "as a clock shows it: `14:30:00`, or `\"14:30\"`"},
                  &SkyMoment::time, &light::CivilTime::hours, timeOfDay()),
        momentKey({.name = "utc_offset",
                   .doc = "the hours that the clock is ahead of UTC, summer time included"},
                  &SkyMoment::time, &light::CivilTime::utcOffset, number({-14, 14})),
        key({.name = "up", .doc = "the axis that is upwards"}, &Sky::place, &SunPlace::up,
            upAxis()),
        key({.name = "turbidity", .doc = "how hazy the air is", .always = true}, &Sky::turbidity,
            number(hazes)),
        key({.name = "ground_albedo",
             .doc = "of the ground, whose light brightens the sky and is seen below the horizon"},
            &Sky::groundAlbedo, colour(zeroToOne)),
        key({.name = "ground",
             .doc =
                 "whether the ground is seen below the horizon. It shines by the sky and the sun "
                 "of this light: `ground_albedo` x irradiance / pi. Else it is black there"},
            &Sky::ground, flag()),
        key({.name = "sun", .doc = "whether the sun shines too"}, &Sky::sun, flag()),
        key({.name = "sun_size",
             .doc = "the sun's diameter. It does not change how much light the sun sends; 0 gives "
                    "parallel rays",
             .comment = "degrees"},
            &Sky::sunSize, number({0, 90})),
        key({.name = "sun_strength", .doc = "multiplies the sun alone"}, &Sky::sunStrength,
            number(notNegative)),
        key({.name = "strength",
             .doc = "multiplies sky and sun. At 1 they are in W / (m^2 sr) and W / m^2, as the eye "
                    "weighs them",
             .always = true},
            &Sky::strength, number(notNegative)),
        key({.name = "visible", .doc = "whether the camera sees the sky and the sun"},
            &Sky::visible, flag()),
    };
}

std::vector<Exclusion> placedTwice() {
    std::vector<Exclusion> exclusions;
    for (const char* name : momentKeys)
        for (const char* other : {"elevation", "azimuth"})
            exclusions.push_back({name, other, "both say where the sun stands"});
    return exclusions;
}

void checkMoment(const TomlTable& table, Sky& sky) {
    for (const char* name : momentKeys)
        if (!table.has(name))
            throw table.error("has no {}; where the sun stands follows from {}", name,
                              fmt::join(momentKeys, ", "));
    const auto& [place, time] = *sky.moment;
    const light::SolarPosition sun = light::solarPosition(time, place);
    if (sun.elevation < 0) {
        const auto rise = light::nextSunrise(time, place);
        throw table.find("time")->error(
            "has the sun {:.1f} degrees below the horizon, at {}; {}", -sun.elevation,
            light::timeText(time),
            rise ? "it rises next at " + light::timeText(*rise) : "it does not rise within a year");
    }
    sky.place.elevation = std::min(sun.elevation, 90.0);
    sky.place.azimuth = sun.azimuth;
}

void checkSky(const TomlTable& table, Sky& sky) {
    if (sky.moment)
        checkMoment(table, sky);
    else if (!table.has("elevation"))
        throw table.error(
            "is a sky that does not say where its sun stands; give elevation = 40, azimuth = 120, "
            "or latitude, longitude, date, time and utc_offset");
    if (!sky.sun)
        for (const char* name : {"sun_size", "sun_strength"})
            if (const auto value = table.find(name))
                throw value->error("is of the sun, and sun = false leaves it out");
}

}  // namespace

template <>
const KeyTable<Sky>& keysOf() {
    static const KeyTable<Sky> table{.id = "light.sky",
                                     .where = "a [[light]] of type sky",
                                     .tag = "sky",
                                     .exclusions = placedTwice(),
                                     .keys = skyKeys(),
                                     .check = checkSky,
                                     .outer = outerOfLight,
                                     .least = "elevation = 40",
                                     .path = "light[0]"};
    return table;
}

}  // namespace woodcock::scene
