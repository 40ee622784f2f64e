# SPDX-License-Identifier: Apache-2.0
# Deliberate defects, read by run.sh; see there for the arguments of `defect`. Most are biased by so
# little that a picture would not show them.
stages=lib/woodcock/render/stages
lanes=lib/woodcock/render/lanes
media=$stages/shade_media.cpp
light=$stages/light.cpp
lookAhead=$stages/look_ahead.cpp
surfaces=$stages/shade_surfaces.cpp
tracking=lib/woodcock/medium/tracking.cpp
bsdf=lib/woodcock/surface/bsdf.cpp

# ---- grid

defect "majorants 2 % too low" 'Majorants.*:CellWalks.*' "intervals of the walk" \
    lib/woodcock/grid/majorants.cpp \
    'static_cast<float>(r.max * options.scale)' 'static_cast<float>(r.max * options.scale * 0.98)'

defect "block ranges without the neighbours' layer" 'Field.*:BlockRanges.*:Majorants.*' "" \
    lib/woodcock/grid/block_ranges.cpp \
    'r.add(field.storedRange(ref, layer(sideOf(i))));' ''

defect "2^3 cells without their far layers" 'Majorants.*' "intervals of the walk" \
    lib/woodcock/grid/majorants.cpp \
    'r.add(layer[2 * inner]);' ''

defect "tiles hold the background" 'Field.*:VdbLoad.*' "only tiles" \
    lib/woodcock/grid/field.cpp \
    'addConstant(t.value)' 'addConstant(source_.background)'

defect "support ends at the outermost voxels" 'Field.*' "table of slabs" \
    lib/woodcock/grid/field.cpp \
    'field_.support_ = {box.lower - Vec3d{1, 1, 1}, box.upper + Vec3d{1, 1, 1}}' \
    'field_.support_ = {box.lower, box.upper}'

defect "motion looks up once" 'Motion.*' "" \
    lib/woodcock/grid/motion.h \
    'return index - velocityAt(index - first) * dt;' 'return index - first;'

defect "motion backwards in time" 'Motion.*:Velocities.*' "even velocity" \
    lib/woodcock/grid/motion.h \
    'return index - velocityAt(index - first) * dt;' 'return index + velocityAt(index + first) * dt;'

defect "bounds of motion without the second look-up" 'Motion.*:MovedRanges.*' "bounds in motion" \
    lib/woodcock/grid/motion.cpp \
    'return moved(first);' 'return first;'

defect "staggered velocities on the other faces" 'Velocities.*' "" \
    lib/woodcock/scene/load.cpp \
    '.offset[static_cast<int>(i)] = -0.5;' '.offset[static_cast<int>(i)] = 0.5;'

# ---- medium

defect "transform transposed" 'BuildScene.*:MediumPart.*:Invariance.Orientation' "" \
    lib/woodcock/medium/medium.cpp \
    'indexFromWorld_ = d_.worldFromIndex.inverse();' \
    'const Affine3d m = d_.worldFromIndex.inverse();
    for (int i = 0; i < 3; ++i)
        indexFromWorld_.column[static_cast<std::size_t>(i)] = {m.column[0][i], m.column[1][i],
                                                               m.column[2][i]};
    indexFromWorld_.translation = m.translation;'

defect "taps off by half a voxel" 'Distance.*:Transmittance.*' "table of slabs" \
    lib/woodcock/medium/look_up.h \
    'field.stochasticVoxel(index, how.bits)' \
    'field.stochasticVoxel(index + Vec3d{0, 0.5, 0}, how.bits)'

defect "absorption's weight lost" 'Distance.*' "half-spaces" \
    $tracking \
    'throughput[0] *= 1 - absorption[0] / mu;' ''

defect "albedo grid forgotten in blue" 'Distance.*:Invariance.AlbedoGrids*' "" \
    $tracking \
    'channels<N>(part.scattering()) * s.f * s.albedo;' \
    'channels<N>(part.scattering()) * s.f *
        Spectrum<N>::map([&](int c) { return c == 2 ? 1.0f : s.albedo[c]; });'

defect "null collisions weighted as if grey" 'Distance.*' "chromatic slabs" \
    $tracking \
    'null * static_cast<float>(1 / (mu * (1 - p)))' 'Spectrum<N>(1.0f)'

defect "residual control dropped" 'Transmittance.*' "linear ramp" \
    $tracking \
    'control += (s.t1 - s.t0) * least();' ''

defect "control of cut cells dropped" 'Transmittance.*:RefinedWalk.*' "" \
    $tracking \
    'if (cut) control += controlled;' 'if (cut) control += 0 * controlled;'

defect "corrections of a sun's depth half as large" 'DepthGrid.*' "grids of depths" \
    lib/woodcock/medium/corrected_transmittance.cpp \
    'static_cast<float>(1 / std::min' 'static_cast<float>(0.5 / std::min'

defect "a sun's depth taken for that beyond a boundary" 'SurfaceLayers*' "pictures by grids" \
    $stages/shadow_walk.cpp \
    'batch.pieces.size() == pieces + 1' 'batch.pieces.size() > pieces'

defect "several events near a sun count for too much" '' "pictures by grids" \
    $stages/several_events.cpp \
    'p.sunShare = severalEventsShare;' 'p.sunShare = 1.5f * severalEventsShare;'

defect "roulette without division" 'Distance.*:Transmittance.*' "deep slabs" \
    lib/woodcock/medium/roulette.h \
    'weight *= threshold_ / lowest_' 'weight *= 1.0f'

defect "every scattering is the first volume's" 'Distance.*' "" \
    $tracking \
    'q.t = process.t(), q.part = process.index();' 'q.t = process.t(), q.part = 0;'

defect "phase function samples the wrong side" 'Phase.*' "phase function" \
    lib/woodcock/medium/phase/turn.h \
    'return below < above ? 1 - below : above - 1;' \
    'return below < above ? below - 1 : 1 - above;'

defect "similar media absorb less under an albedo grid" 'SimilarMedium.*' "" \
    lib/woodcock/medium/similar_medium.cpp \
    'c.loss = part.loss() * static_cast<float>(1 / kept);' ''

# ---- lanes

defect "lanes draw the same numbers again" 'Lane*' "lanes and paths one by one" \
    $lanes/lane_tracer-inl.h \
    'count_.set(hn::RebindMask(lanesU, where), count + hn::Set(lanesU, 1));' \
    'count_.set(hn::RebindMask(lanesU, where), count);'

defect "lanes come to the face behind" 'Lane*' "lanes and paths one by one" \
    $lanes/lane_walk-inl.h \
    'const I beyond = face - hn::IfThenElse(forward, zero, one);' 'const I beyond = face - one;'

defect "lanes' flights in one direction count for one too few" 'Lanes.*' "lanes and paths one by one" \
    $lanes/lane_scattering-inl.h \
    'share_[lane] = 1.0f / static_cast<float>(l.flights);' \
    'share_[lane] = 1.0f / static_cast<float>(more);'

defect "lanes' roulette is made up for twice" 'Lanes.*' "" \
    $lanes/lane_scattering-inl.h \
    'w[c] * (factor - 1) * expectedToScatter' 'w[c] * (1 - factor) * expectedToScatter'

defect "lanes' chance is what is left of it" 'Lanes.*' "lanes and paths one by one" \
    $lanes/lane_scattering-inl.h \
    'expectedWith(c, aheadIn(c)) * (after - before));' 'expectedWith(c, aheadIn(c)) * after);'

defect "lanes' decisions are expected to lose what goes on" 'Lanes.*' "lanes and paths one by one" \
    $lanes/lane_expected-inl.h \
    '(scattering * scattered + null * others)' \
    '(scattering * scattered + null * (others - others))'

defect "lanes that leave are expected to have collided" '' "lanes and paths one by one" \
    $lanes/lane_expected-inl.h \
    'gain_[c][lane] * (drawn_[lane] - depth_[lane])' \
    'gain_[c][lane] * (drawn_[lane] - depth_[lane] - 1)'

defect "lanes' camera rays are worth as much as if nothing passed" 'Lanes.*' "lanes and paths one by one" \
    $lanes/lane_camera-inl.h \
    'toRgb((Spectrum<N>(1.0f) - l.passes) * l.worth)' 'toRgb(l.worth)'

defect "lanes' camera rays bring all light from each of their points" 'Lanes.*' "lanes and paths one by one" \
    $lanes/lane_camera-inl.h \
    '(density * scene_.points)' 'density'

defect "lanes without depth left collide in empty cells" 'Lanes.*' "" \
    $lanes/lane_walk-inl.h \
    'hn::IfThenElse(mu_.get() > zero, depth_.get() * perMu_.get(), all(huge))' \
    'depth_.get() * perMu_.get()'

defect "lanes that split predict as before" 'Lanes.*' "lanes and paths one by one" \
    $lanes/lane_scattering-inl.h \
    'setLane(predicted_, lane, laneOf(predicted_, lane) * factor);
    if (copies' 'if (copies'

defect "lanes take a prediction twice" '' "lanes and paths one by one" \
    $lanes/lane_sun-inl.h \
    'predicted_[c].set(departing, hn::Zero(lanesF));' ''

defect "lanes meet lamps that next events bring, too" '' "lanes in the light of lamps" \
    $lanes/lane_paths-inl.h \
    'hit.radiance * static_cast<float>(hitWeight(lane, light))' 'hit.radiance'

defect "lanes' lamps are as bright everywhere" '' "lanes in the light of lamps" \
    $lanes/lane_sun-inl.h \
    'all(scene_.centre.weight.maximum()) * sunScale_.get() *' \
    'all(scene_.centre.weight.maximum()) *'

# ---- light

defect "a sun stays in the image that it is taken from" 'EnvironmentMap.*' "" \
    lib/woodcock/light/environment_map.cpp \
    'left[c] = std::min(p[c], sky[c]);' 'left[c] = p[c];'

defect "sun's irradiance without the cosine" 'Sun.*' "sun" \
    lib/woodcock/light/sun.cpp \
    'irradiance_ * static_cast<float>(1 / (pi * sinHalf_ * sinHalf_))' \
    'irradiance_ * static_cast<float>(1 / (2 * pi * oneMinusCos_))'

defect "sphere's solid angle as if it were flat" 'SphereLight.*' "local lights" \
    lib/woodcock/light/sphere_light.cpp \
    's.weight = radiance * static_cast<float>(1 / s.pdf);' \
    's.weight = radiance * static_cast<float>(pi * sin2);'

defect "spot's soft edge is straight" 'SpotLight.*' "spots" \
    lib/woodcock/light/spot_light.cpp \
    'return x * x * (3 - 2 * x);' 'return x;'

defect "spread keeps the radiance instead of the power" 'Spread.*' "rectangles" \
    lib/woodcock/light/spread.cpp \
    'std::max(0.0, tangent_ - tangent) / rest_' 'std::max(0.0, tangent_ - tangent) / tangent_'

defect "rectangle's sampling ends at a corner too early" 'SeenRectangle.*' "rectangles" \
    lib/woodcock/light/seen_rectangle.cpp \
    'h0 + u1 * (h1 - h0)' 'h0 + 0.99 * u1 * (h1 - h0)'

defect "quarter of a profile repeated instead of mirrored" 'IesProfile.*' "photometric profiles" \
    lib/woodcock/light/ies_profile.cpp \
    'add(180 - angle), add(180 + angle);' 'add(90 + angle), add(180 + angle);'

defect "image sampled evenly in angle" 'EnvironmentMap.*' "environment images" \
    lib/woodcock/light/environment_map.cpp \
    'const double cosine = top + (bottom - top) * fy;' \
    'const double cosine = std::cos(pi * (static_cast<double>(y) + fy) / height_);'

# ---- render

defect "phase sign flipped for lights" 'Slab.*:Furnace.*:PointLight.*' "table of slabs" \
    $light \
    'phaseDensity(p, dot(p.from.forward, s.direction), s.weight)' \
    'phaseDensity(p, -dot(p.from.forward, s.direction), s.weight)'

defect "all octaves come through the first one's medium" 'Octaves.*' "" \
    lib/woodcock/render/media_table.cpp \
    'return {static_cast<std::uint8_t>(1 + i), medium::octave::total(octaves_)};' \
    'return {1, medium::octave::total(octaves_)};'

defect "g sampled, isotropic evaluated" 'Slab.*:Furnace.*' "table of slabs" \
    $media \
    'p.origin = position, p.direction = s.direction, p.phasePdf = s.pdf;' \
    'p.origin = position, p.direction = s.direction, p.phasePdf = 1 / (4 * pi);'

defect "MIS forgets how a light was picked" 'Furnace*:LocalLights.*' "" \
    $light \
    'powerHeuristic(s.pdf * chosen.probability, phase)' 'powerHeuristic(s.pdf, phase)'

defect "local lights counted by both samplings" 'PointLight.*:SphereLight.*' "airlight" \
    $lookAhead \
    '(pdf + flight.density(e, t))' 'pdf'

defect "shadow rays go on behind the light" 'PointLight.*:SphereLight.*' "" \
    $lookAhead \
    'ray.tMax = s.distance;' 'ray.tMax = std::numeric_limits<double>::infinity();'

defect "numbers used twice" 'Slab.*:Furnace.*' "table of slabs" \
    $stages/event_numbers.h \
    'p.sequence.draw(set + 1)' 'p.sequence.draw(set)'

defect "roulette of high orders without factor" 'Furnace*' "furnace at any depth" \
    $stages/roulette.h \
    'p.throughput *= endless ? 1 / endlessSurvival : 1.41421356f;' ''

defect "one order of scattering too few" 'Slab.*:Invariance.Bounds*' "" \
    lib/woodcock/render/traced_scene.h \
    'scatterings < *options.maxScatterings' 'scatterings + 1 < *options.maxScatterings'

# ---- surfaces

defect "shadow rays see the outside's medium alone" 'SurfaceLayers*' "media inside surfaces" \
    $stages/shadow_walk.cpp \
    'traced.mediumAround(shadow.mediumSet, way.inside())' 'traced.media.number(shadow.mediumSet, 0)'

defect "priorities upside down" 'SurfaceLayers*' "nested dielectrics" \
    lib/woodcock/render/nested_media.cpp \
    'rank(instance) > rank(best)' 'rank(instance) < rank(best)'

defect "refracted light stays in the medium it came from" 'SurfaceLayers*' "plates of glass" \
    $surfaces \
    'if (b.transmitted) s.way.goOnFromHit(crossing.beyond);' ''

defect "emissive surfaces counted in full by both samplings" 'SurfaceLayers*' "emissive surfaces" \
    $surfaces \
    'static_cast<float>(hitWeight(p, pdf))' \
    'static_cast<float>(hitWeight(p, [&] { return 0 * pdf(); }))'

defect "roulette of bounces without factor" 'SurfaceLayers*' "emissive surfaces" \
    $stages/roulette.h \
    'p.throughput *= 1 / survival;' 'p.throughput *= 1.0f;'

defect "shadow catchers forget the sky" 'SurfaceLayers*' "" \
    $surfaces \
    'if (caught) addUnoccluded(traced, p);' ''

# ---- camera, film

defect "picture off by half a pixel" 'Camera.*:Session.*:Transmittance.OfThinRays*' "" \
    lib/woodcock/camera/camera_rays.cpp \
    'const double sx = (2 * x - width_) / h' 'const double sx = (2 * x + 1 - width_) / h'

defect "a pixel's first sample is not summed" 'Film.*' "" \
    lib/woodcock/image/film.cpp \
    'p.radiance[i] += v;' 'p.radiance[i] += p.samples > 0 ? v : 0;'

defect "what is drawn already is drawn again" 'Resume.*' "" \
    lib/woodcock/render/session.cpp \
    'state_.drawn[pixelOf(x, y)] = sample + 1;' \
    'state_.drawn[pixelOf(x, y)] = sample;'

defect "kept sums are floats" 'FilmStates.*:Resume.*' "" \
    lib/woodcock/image/film_state.cpp \
    'act(component.name + ".lo", wordsOf(component));' ';'

defect "of deep parts, the last one's bins alone" 'DeepFilm.*:MergeParts.*' "" \
    lib/woodcock/image/deep_film.cpp \
    'bin.stopped += more.stopped;' 'bin.stopped = more.stopped;'

defect "a single missing sample is passed over" 'PartCoverage.*' "" \
    lib/woodcock/render/part_coverage.cpp \
    'if (part->first > reached)' 'if (part->first > reached + 4)'

# ---- surface

defect "refraction leaves radiance as it is" 'Bsdf*' "" \
    $bsdf \
    'drawn.transmitted ? static_cast<float>(1 / (view.eta * view.eta)) : 1.0f' '1.0f'

defect "facets seen through glass without their index" 'Bsdf*' "" \
    $bsdf \
    'cosine * eta * eta * beyond' 'cosine * eta * beyond'

defect "the lobe's number used again as it is" 'Bsdf*' "" \
    $bsdf \
    'u = std::clamp((place - before) / chosen->weight, 0.0, 1 - 0x1p-53);' ''

defect "one lobe's leak taken for the other's light" 'Bsdf*' "" \
    $bsdf \
    'if (!(dot(drawn.direction, view.normal) > 0)) return {};' ''

defect "shading normals never bent" 'Bsdf*' "" \
    $bsdf \
    'if (above >= least) return shading;' 'if (above >= -2) return shading;'

defect "grazing rays below the horizon" 'Bsdf*' "" \
    $bsdf \
    'view.local.z = std::max(view.local.z, 1e-300);' ''

defect "facets hidden from one side alone" 'Bsdf*:Ggx*' "" \
    lib/woodcock/surface/microfacet.h \
    'z * (out.z + o) / (z * o + out.z * slope(in))' '1 + 0 * (z + o + slope(in))'

defect "surfaces in one place met one by one" 'CoincidentSurfaces*:*SameBody*' "surfaces in one place" \
    lib/woodcock/surface/geometry.cpp \
    'slack, coincident || point.coincident, i, point}' 'slack, false, i, point}'

defect "what facets hide lost again" 'Bsdf*' "rough facets" \
    $bsdf \
    'return sampleAgain(lobe, view, u);
    }' 'return {};
    }'

defect "metals in glass as in air" 'Bsdf*' "" \
    $bsdf \
    'double{lobe.k[c]} / ior' 'double{lobe.k[c]}'

defect "texels at their corners" 'TextureImage*' "" \
    lib/woodcock/surface/texture.cpp \
    'place * size - 0.5' 'place * size'

# ---- approximations, adaptive sampling, emission, comparison

defect "the jackknife's correction halved" 'Marching.*' "" \
    lib/woodcock/medium/marching.cpp \
    'minusLogCosine(half * (double{a[c]} - b[c]) * width) / width' \
    '0.5 * minusLogCosine(half * (double{a[c]} - b[c]) * width) / width'

defect "coarse voxels are one of eight" 'Coarsen.*' "" \
    lib/woodcock/grid/coarsen.cpp \
    'share.fill(1.0 / 8);' 'share.fill(0), share[0] = 1;'

defect "a pixel's number knows its own samples" 'SamplePlan.*:Adaptive.*' "" \
    lib/woodcock/render/sample_plan.cpp \
    'if ((u + v + x + y) % 2 != 0 && p.weight > 0)' 'if (u == x && v == y && p.weight > 0)'

defect "the sky counts as what is seen" 'Film.Noise*:Noise.*' "" \
    lib/woodcock/image/film.cpp \
    'double{sample.radiance[i]} - double{sample.background[i]}' 'double{sample.radiance[i]}'

defect "tiles from the top" 'TileOrder.*' "" \
    lib/woodcock/render/tile_order.cpp \
    'return sum - std::floor(sum);' 'return row + 0 * sum;'

defect "dear pixels get as many samples as cheap ones" 'SamplePlan.*' "" \
    lib/woodcock/render/sample_plan.cpp \
    '1 + costOfAnEvent * events / weight' '1 + 0 * costOfAnEvent * events / weight'

defect "light of a temperature falls with its cube" 'Blackbody*' "" \
    lib/woodcock/medium/blackbody.cpp \
    '1e-6 * stefanBoltzmann / pi * square * square' \
    '1e-6 * stefanBoltzmann / pi * square * std::sqrt(square)'

defect "what glows is drawn by twice its density" 'VolumeEmission.*' "glow along a line" \
    lib/woodcock/medium/emission.cpp \
    '0.5 / even + 0.5 * std::exp(-extinction * (t - first)) / dimmed' '1 / even'

defect "standard errors of tiles without their root" 'FalseAlarms.*:Comparison.*' "" \
    lib/woodcock/compare/tile_test.cpp \
    'all.error = std::sqrt(variance) / n;' 'all.error = std::sqrt(variance / n) / n;'

defect "Cycles' bounces are scatterings" 'Cycles*' "" \
    tools/cycles/mapping.cpp \
    'events.value_or(cyclesMostBounces + 1) - 1' 'events.value_or(cyclesMostBounces + 1)'
