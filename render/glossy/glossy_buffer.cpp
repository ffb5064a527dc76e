#include "render/glossy/glossy_buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <new>

#include "render/vocabulary/check.h"

namespace hilcam {

namespace {

constexpr std::size_t kRaysPerLobe = 4;  // on average over a part; a lobe has at most ten

constexpr std::array kFloatColumns{
    &GlossyColumns::start_x,   &GlossyColumns::start_y,  &GlossyColumns::start_z,
    &GlossyColumns::normal_x,  &GlossyColumns::normal_y, &GlossyColumns::normal_z,
    &GlossyColumns::column_px, &GlossyColumns::met_x,    &GlossyColumns::met_y,
    &GlossyColumns::met_z,     &GlossyColumns::hit,      &GlossyColumns::per_density_sr};
constexpr std::array kWordColumns{&GlossyColumns::object, &GlossyColumns::side};

}  // namespace

void GlossyBuffer::Unmap::operator()(void* room) const { munmap(room, bytes); }

template <class T>
std::unique_ptr<T[], GlossyBuffer::Unmap> GlossyBuffer::room_for(std::size_t count) {
    const std::size_t bytes = std::max<std::size_t>(count, 1) * sizeof(T);
    void* const room =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) throw std::bad_alloc();
    return {static_cast<T*>(room), Unmap{bytes}};
}

GlossyBuffer::GlossyBuffer(int width_px, int height_px, std::size_t parts, std::size_t lobes)
    : width_(width_px),
      height_(height_px),
      parts_(parts),
      points_(room_for<GlossyPoint>(parts * lobes)),
      rays_(room_for<GlossyRay>(parts * lobes * kRaysPerLobe)),
      first_of_pixel_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)),
      end_of_pixel_(first_of_pixel_.size()) {
    const std::size_t rays = parts * lobes * kRaysPerLobe, apart = rays + GlossyColumns::kPadding;
    HILCAM_CHECK(rays < 1u << 31);
    for (std::size_t i = 0; i < parts; ++i) {
        Part& part = parts_[i];
        part.first_point_ = static_cast<std::uint32_t>(i * lobes);
        part.first_ray_ = static_cast<std::uint32_t>(i * lobes * kRaysPerLobe);
        part.points_ = {points_.get() + part.first_point_, lobes};
        part.rays_ = {rays_.get() + part.first_ray_, lobes * kRaysPerLobe};
    }
    floats_ = room_for<float>(kFloatColumns.size() * apart);
    words_ = room_for<std::uint32_t>(kWordColumns.size() * apart);
    sums_ = room_for<GlossySum>(rays);
    for (std::size_t i = 0; i < kFloatColumns.size(); ++i)
        columns_.*kFloatColumns[i] = floats_.get() + i * apart;
    for (std::size_t i = 0; i < kWordColumns.size(); ++i)
        columns_.*kWordColumns[i] = words_.get() + i * apart;
    columns_.sum = sums_.get();
}

GlossyRay* GlossyBuffer::Part::add_ray(const GlossyPoint& of) {
    if (ray_count_ == rays_.size()) return nullptr;
    GlossyRay* const ray = new (&rays_[ray_count_++]) GlossyRay;
    ray->point = (first_point_ + static_cast<std::uint32_t>(&of - points_.data())) & 0x7FFFFFFFu;
    return ray;
}

GlossyBuffer::Part& GlossyBuffer::begin(std::size_t number, const PixelBox& box, float share) {
    skip(number);
    parts_[number].box_ = box, parts_[number].share_ = share;
    return parts_[number];
}

void GlossyBuffer::skip(std::size_t number) {
    Part& part = parts_[number];
    if (part.sorted_)
        for (int y = part.box_.y0; y < part.box_.y1; ++y)
            for (std::size_t at = index(part.box_.x0, y); at < index(part.box_.x0, y) + part.width(); ++at)
                first_of_pixel_[at] = end_of_pixel_[at] = 0;
    part.point_count_ = part.ray_count_ = 0, part.sorted_ = false;
}

// A counting sort: rays of a pixel keep their order.
void GlossyBuffer::sort(Part& part) {
    const auto rays = std::span(part.rays_).first(part.ray_count_);
    const std::size_t width = part.width();
    const auto in_frame = [&](std::size_t pixel) {
        return index(part.box_.x0, part.box_.y0 + static_cast<int>(pixel / width)) + pixel % width;
    };
    const std::size_t pixels = width * static_cast<std::size_t>(part.box_.y1 - part.box_.y0);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) end_of_pixel_[in_frame(pixel)] = 0;
    for (const GlossyRay& ray : rays) ++end_of_pixel_[in_frame(points_[ray.point].pixel)];
    std::uint32_t next = part.first_ray_;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::size_t at = in_frame(pixel);
        const std::uint32_t count = end_of_pixel_[at];
        first_of_pixel_[at] = end_of_pixel_[at] = next;
        next += count;
    }
    for (const GlossyRay& ray : rays) {
        const GlossyPoint& of = points_[ray.point];
        const std::size_t at = in_frame(of.pixel);
        enter(of, ray, static_cast<int>(at % static_cast<std::size_t>(width_)), end_of_pixel_[at]++);
    }
    part.sorted_ = true;
}

void GlossyBuffer::enter(const GlossyPoint& of, const GlossyRay& ray, int column, std::size_t place) {
    const GlossyColumns& c = columns_;
    c.start_x[place] = of.point_m.x, c.start_y[place] = of.point_m.y, c.start_z[place] = of.point_m.z;
    c.normal_x[place] = of.normal.x, c.normal_y[place] = of.normal.y, c.normal_z[place] = of.normal.z;
    c.object[place] = of.object, c.side[place] = glossy_side(of.surface, of.back);
    c.column_px[place] = static_cast<float>(column);
    c.met_x[place] = ray.met_m.x, c.met_y[place] = ray.met_m.y, c.met_z[place] = ray.met_m.z;
    c.hit[place] = ray.free ? 0.0f : 1.0f;
    c.per_density_sr[place] = ray.per_density_sr;
    GlossySum& sum = c.sum[place];
    sum.light = ray.free ? Spectrum{} : of.per_light * ray.light;
    sum.towards = ray.towards;
    sum.free = ray.free ? ray.towards : decltype(sum.free){};
}

}  // namespace hilcam
