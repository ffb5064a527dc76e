#include "render/light/kept_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "render/light/lamp_light.h"
#include "render/scene/brdf_microfacet.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

using Nodes = tbb::blocked_range<std::size_t>;
constexpr std::size_t kBlock = 256;  // nodes that a thread takes at a time; no result depends on it

float schlick_normal_incidence(float refractive_index) {
    const float r = (refractive_index - 1) / (refractive_index + 1);
    return r * r;
}

// A cone's directions, sixteen of equal solid angle (Vogel 1979), for the irradiance that it makes.
constexpr int kConeDirections = 16;
std::array<Vec3f, kConeDirections> cone_directions(Vec3f axis_dir, float cone_cosine) {
    const Frame axis(axis_dir);
    std::array<Vec3f, kConeDirections> out;
    for (int i = 0; i < kConeDirections; ++i) {
        const float below = (static_cast<float>(i) + 0.5f) / kConeDirections * (1 - cone_cosine);
        const float r = std::sqrt(std::max(0.0f, below * (2 - below))),
                    phi = 2 * kPiF * 0.61803399f * static_cast<float>(i);
        out[static_cast<std::size_t>(i)] = axis.to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
    }
    return out;
}

}  // namespace

void KeptLight::Workspace::reserve(const KeptLight& light) {
    const std::size_t nodes = std::max(light.table().size(), senders_.size());
    senders_.resize(nodes), radiosity_.resize(nodes), first_.resize(nodes), now_.resize(nodes),
        before_.resize(nodes);
}

KeptLight::KeptLight(std::shared_ptr<const TransferTable> table, const std::vector<Material>& materials,
                     const ColorBands& bands, float step_rad)
    // A lobe's half width is about twice its alpha; sixty directions stand 0.32 rad apart.
    : table_(std::move(table)),
      least_alpha_(1.16f / std::sqrt(static_cast<float>(table_->directions()))),
      step_rad_(step_rad) {
    for (const Material& material : materials) {
        albedos_.emplace_back(material);
        materials_.push_back(&material);
    }
    for (const Vec3f d : transfer_directions(table_->directions()))
        local_x_.push_back(d.x), local_y_.push_back(d.y), local_z_.push_back(d.z), counts_.push_back(1);
    while (counts_.size() % kLanes != 0)
        local_x_.push_back(0), local_y_.push_back(0), local_z_.push_back(1), counts_.push_back(0);

    const std::vector<LightNode>& nodes = table_->nodes().nodes();
    const bool textured =
        std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.texture >= 0; });
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Material& material = *materials_[nodes[n].surface];
        Spectrum white = albedos_[nodes[n].surface].white();
        if (textured) {
            colors_.push_back(Spectrum{});
            colors_.back().bin.fill(1);
            if (material.texture >= 0) colors_.back() = bands.spectrum(nodes[n].color);
            white = white * colors_.back();
        }
        white_.emplace_back((1 / kPiF) * white);
        // Curved surfaces widen lobes, so that any may be asked for.
        const bool lobe = material.has_facets();
        first_along_.push_back(lobe ? static_cast<std::uint32_t>(along_) : kNoLobe);
        if (lobe) along_ += table_->entries(n).size();
    }
}

KeptTerm KeptLight::make_term(KeptSource::Kind kind) const {
    KeptTerm term;
    term.irradiance.resize(table_->size());
    if (kind == KeptSource::Kind::kSun) term.along.resize(along_);
    if (kind == KeptSource::Kind::kCone) term.seen.resize(table_->size());
    return term;
}

std::size_t KeptLight::bytes() const {
    return colors_.size() * sizeof(Spectrum) + white_.size() * sizeof(PackedSpectrum) +
           first_along_.size() * sizeof(std::uint32_t);
}

KeptLight::Local KeptLight::local(std::size_t node) const {
    return {Frame(unpack_normal(table_->nodes().nodes()[node].mean_normal)), table_->turn(node)};
}

// --- what nodes receive from the source, and send

void KeptLight::solve(const KeptSource& source, const EmbreeScene& scene, std::size_t object, Workspace& work,
                      KeptTerm& term) const {
    term.source = source;
    if (table_->size() == 0) return;
    light_nodes(source, scene, object, work, term);
    gather_first(work, term);
    bounce(work);
    tbb::parallel_for(Nodes(0, table_->size(), kBlock), [&](const Nodes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            term.irradiance[n] = PackedSpectrum(work.now_[n]);
            if (term.along.empty() || first_along_[n] == kNoLobe) continue;
            PackedSpectrum* along = term.along.data() + first_along_[n];
            for (const TransferTable::Entry e : table_->entries(n)) {
                *along = PackedSpectrum(along->unpacked() + work.radiosity_[e.node].unpacked());
                ++along;
            }
        }
    });
}

void KeptLight::light_nodes(const KeptSource& source, const EmbreeScene& scene, std::size_t object,
                            Workspace& work, KeptTerm& term) const {
    tbb::parallel_for(Nodes(0, table_->size(), kBlock), [&](const Nodes& r) {
        for (std::size_t first = r.begin(); first < r.end(); first += kBlock)
            light_block(source, scene, object, first, std::min(r.end(), first + kBlock), work, term);
    });
}

void KeptLight::light_block(const KeptSource& source, const EmbreeScene& scene, std::size_t object,
                            std::size_t first, std::size_t last, Workspace& work, KeptTerm& term) const {
    // What is asked of each node: how much its points would receive, rays sent, and rays that get through.
    struct Asked {
        float received = 0;
        int points = 0, rays = 0, lit = 0;
        Vec3f dir;
        Vec3f normal{};  // of the points that face the source, by how much they receive; not unit
    };
    std::array<Asked, kBlock> asked;
    RayPacket rays;
    std::array<std::size_t, kPacketSize> of;
    rays.count = 0;
    const auto flush = [&] {
        if (rays.count == 0) return;
        const std::uint32_t blocked = scene.occluded_by(object, rays);
        for (int i = 0; i < rays.count; ++i)
            if (!(blocked >> i & 1u)) ++asked[of[static_cast<std::size_t>(i)]].lit;
        rays.count = 0;
    };
    const bool cone = source.kind == KeptSource::Kind::kCone;
    const auto cone_dirs = cone_directions(source.dir, cone ? source.cone_cosine : 1);
    for (std::size_t n = first; n < last; ++n) {
        Asked& a = asked[n - first];
        a.dir = source.dir;
        if (source.kind == KeptSource::Kind::kGlow) continue;
        const LightNode& node = table_->nodes().nodes()[n];
        float most = 0;
        for (std::size_t p = 0; p < LightNode::kPoints; ++p) {
            if (!table_->is_live(n, p)) continue;
            ++a.points;
            const Vec3f normal = unpack_normal(node.normal[p]), geometric = unpack_normal(node.geometric[p]);
            Vec3f dir = source.dir;
            float strength = 1, until_m = std::numeric_limits<float>::infinity();
            if (source.kind == KeptSource::Kind::kLamp) {
                const Vec3f way = source.position_m - node.point_m[p];
                const float distance_m = std::max(length(way), 1e-3f);
                dir = way / distance_m;
                strength = static_cast<float>(source.beam->at(to_double(source.dir), to_double(-dir))) /
                           (distance_m * distance_m);
                until_m = std::max(0.0f, distance_m * (1 - 1e-5f) - static_cast<float>(kLampClearance_m));
            }
            float cosine = std::max(0.0f, dot(normal, dir));
            if (cone) {
                float sum = 0, faced = 0;
                for (const Vec3f d : cone_dirs) {
                    sum += std::max(0.0f, dot(normal, d));
                    faced += std::max(0.0f, dot(source.dir, d));
                }
                cosine = sum / faced;
            }
            if (cosine * strength <= 0 || (!cone && dot(geometric, dir) <= 0)) continue;
            a.received += cosine * strength;
            a.normal = a.normal + cosine * strength * normal;
            if (cosine * strength > most) most = cosine * strength, a.dir = dir;
            // Two points tell of a node's shadow.
            if (cone || a.rays == 2) continue;
            of[static_cast<std::size_t>(rays.count)] = n - first;
            rays.set(rays.count, node.point_m[p], dir, 0, until_m);
            ++a.rays;
            if (++rays.count == kPacketSize) flush();
        }
    }
    flush();
    for (std::size_t n = first; n < last; ++n) {
        const Asked& a = asked[n - first];
        float share = a.rays > 0 ? static_cast<float>(a.lit) / static_cast<float>(a.rays) : 0;
        if (cone) {
            share = seen_of_cone(source, n);
            term.seen[n] = static_cast<std::uint8_t>(std::lround(255 * share));
        }
        const float mean = a.points > 0 ? a.received / static_cast<float>(a.points) : 0;
        Workspace::Sender& sender = work.senders_[n];
        send(n, a.dir, a.normal, share * mean, sender);
        if (source.kind == KeptSource::Kind::kGlow)
            sender.diffuse = PackedSpectrum(materials_[table_->nodes().nodes()[n].surface]->emission);
        if (cone && sender.alpha > 0) {
            const float sine = std::sqrt(std::max(0.0f, 1 - source.cone_cosine * source.cone_cosine));
            sender.alpha = std::min(1.0f, std::hypot(sender.alpha, 0.5f * sine));
        }
    }
}

// facing: along the normal of what is lit; received: irradiance, per unit of the source.
void KeptLight::send(std::size_t n, Vec3f source_dir, Vec3f facing, float received,
                     Workspace::Sender& sender) const {
    const LightNode& node = table_->nodes().nodes()[n];
    sender = {};
    if (!(received > 0)) return;
    const Vec3f normal = normalized(facing);
    const float cosine = std::clamp(dot(normal, source_dir), 1e-3f, 1.0f);
    const Material& material = *materials_[node.surface];
    const MaterialAlbedo& albedo = albedos_[node.surface];
    Spectrum diffuse = (received / kPiF) * albedo.base(cosine);
    if (!colors_.empty()) diffuse = diffuse * colors_[n];
    sender.diffuse = PackedSpectrum(diffuse);
    sender.normal = pack_normal(normal);
    sender.ni = cosine;
    if (!material.has_facets()) return;
    sender.alpha = std::max(material.ggx_alpha, least_alpha_);
    Spectrum normal_incidence = material.highlight;
    if (material.model == ReflectionModel::kDielectric)
        normal_incidence.bin.fill(schlick_normal_incidence(material.refractive_index));
    else if (!colors_.empty())
        normal_incidence = normal_incidence * colors_[n];
    sender.lobe = PackedSpectrum(received * normal_incidence);
    sender.received = received;
}

// --- between nodes

void KeptLight::gather_first(Workspace& work, KeptTerm& term) const {
    // A lamp is taken as seen from the middle of the object: it differs by node, but little.
    const bool lamp = term.source.kind == KeptSource::Kind::kLamp && length(term.source.position_m) > 0;
    const Vec3f source_dir = lamp ? normalized(term.source.position_m) : term.source.dir;
    tbb::parallel_for(Nodes(0, table_->size(), kBlock), [&](const Nodes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            const auto entries = table_->entries(n);
            Spectrum sum;
            if (!entries.empty()) {
                const Local axes = local(n);
                PackedSpectrum* along = term.along.empty() || first_along_[n] == kNoLobe
                                            ? nullptr
                                            : term.along.data() + first_along_[n];
                for (const TransferTable::Entry e : entries) {
                    const Workspace::Sender& from = work.senders_[e.node];
                    Spectrum radiance = from.diffuse.unpacked();
                    if (from.alpha > 0) {
                        const std::size_t d = e.direction;
                        const Vec3f dir = axes.body({local_x_[d], local_y_[d], local_z_[d]});
                        const float no = std::max(-dot(unpack_normal(from.normal), dir), 1e-2f);
                        const float io = -dot(dir, source_dir);
                        const float inverse = 1 / std::sqrt(std::max(2 + 2 * io, 1e-6f));
                        const float nh = std::min((no + from.ni) * inverse, 1.0f), ih = 0.5f / inverse;
                        const float law =
                            ggx_distribution(from.alpha, nh) * ggx_visibility(from.alpha, no, from.ni);
                        // Schlick's term: F0 + (1 - F0) w, of what is received.
                        const float grazing = schlick_weight(ih);
                        radiance += (law * (1 - grazing)) * from.lobe.unpacked();
                        for (float& bin : radiance.bin) bin += law * grazing * from.received;
                    }
                    if (along) *along++ = PackedSpectrum(radiance);
                    sum += radiance;
                }
            }
            work.first_[n] = work.now_[n] = (kPiF / static_cast<float>(table_->counted(n))) * sum;
        }
    });
}

// Bounces until what is left is little, and that by its geometric series: white paint in a hollow keeps light
// for long.
void KeptLight::bounce(Workspace& work) const {
    constexpr int kMostBounces = 64;
    constexpr double kLeft = 0.01, kMostRatio = 0.95;
    double before = 0;
    for (int i = 0; i < kMostBounces; ++i) {
        const Progress step = gather_again(work);
        const double ratio = before > 0 ? std::min(step.change / before, kMostRatio) : kMostRatio;
        const double left = ratio / (1 - ratio);
        before = step.change;
        if (left * step.change > kLeft * step.light) continue;
        tbb::parallel_for(Nodes(0, table_->size(), 4096), [&](const Nodes& r) {
            for (std::size_t n = r.begin(); n < r.end(); ++n)
                for (int b = 0; b < kMaxBins; ++b)
                    work.now_[n][b] +=
                        static_cast<float>(left) * std::max(0.0f, work.now_[n][b] - work.before_[n][b]);
        });
        break;
    }
}

// One more bounce.
KeptLight::Progress KeptLight::gather_again(Workspace& work) const {
    tbb::parallel_for(Nodes(0, table_->size(), 4096), [&](const Nodes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n)
            work.radiosity_[n] = PackedSpectrum(white_[n].unpacked() * work.now_[n]);
    });
    // Sums that do not depend on how the work was shared out.
    return tbb::parallel_deterministic_reduce(
        Nodes(0, table_->size(), kBlock), Progress{},
        [&](const Nodes& r, Progress sum) {
            for (std::size_t n = r.begin(); n < r.end(); ++n) {
                Spectrum met;
                for (const TransferTable::Entry e : table_->entries(n))
                    met += work.radiosity_[e.node].unpacked();
                const Spectrum next = work.first_[n] + (kPiF / static_cast<float>(table_->counted(n))) * met;
                for (int b = 0; b < kMaxBins; ++b)
                    sum.change += static_cast<double>(std::abs(next[b] - work.now_[n][b])),
                        sum.light += static_cast<double>(next[b]);
                work.before_[n] = work.now_[n];
                work.now_[n] = next;
            }
            return sum;
        },
        [](const Progress& a, const Progress& b) {
            return Progress{a.change + b.change, a.light + b.light};
        });
}

// This counts directions in the cone, and those beside it by falling weights.
float KeptLight::seen_of_cone(const KeptSource& source, std::size_t n) const {
    const float half_angle = std::acos(std::clamp(source.cone_cosine, -1.0f, 1.0f));
    float all = 0, free = 0;
    const Vec3f axis = local(n).dir(source.dir);
    // So far beside it that there are half a dozen: of all directions, sin^2 of a cone's half angle times the
    // cosine of its axis are in it.
    constexpr float kEnough = 6, kLeastCosine = 0.25f, kSoft_rad = 0.05f;
    const float share = kEnough / (static_cast<float>(table_->directions()) * std::max(axis.z, kLeastCosine));
    const float outside =
        std::cos(std::max(half_angle + kSoft_rad, std::asin(std::sqrt(std::min(share, 1.0f)))));
    for (std::size_t d = 0; d < static_cast<std::size_t>(table_->directions()); ++d) {
        const float cosine = local_x_[d] * axis.x + local_y_[d] * axis.y + local_z_[d] * axis.z;
        if (cosine <= outside || !table_->is_live(n, table_->point_of(d))) continue;
        const float in = std::min(1.0f, (cosine - outside) / std::max(source.cone_cosine - outside, 1e-3f));
        all += in * in;
        if (table_->is_free(n, d)) free += in * in;
    }
    return all > 0 ? free / all : 0;
}

}  // namespace hilcam
