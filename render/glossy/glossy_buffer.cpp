#include "render/glossy/glossy_buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

#include "render/vocabulary/check.h"

namespace hilcam {

namespace {

constexpr std::size_t kRaysPerLobe = 4;  // on average over a part; a lobe has at most ten

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
      starts_(room_for<GlossyStart>(parts * lobes * kRaysPerLobe)),
      first_of_pixel_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), kNone) {
    HILCAM_CHECK(parts * lobes * kRaysPerLobe < kNone && parts * lobes < 1u << 31);
    for (std::size_t i = 0; i < parts; ++i) {
        Part& part = parts_[i];
        part.first_point_ = static_cast<std::uint32_t>(i * lobes);
        part.first_ray_ = static_cast<std::uint32_t>(i * lobes * kRaysPerLobe);
        part.points_ = {points_.get() + part.first_point_, lobes};
        part.rays_ = {rays_.get() + part.first_ray_, lobes * kRaysPerLobe};
    }
}

GlossyRay* GlossyBuffer::Part::add_ray(const GlossyPoint& of) {
    if (ray_count_ == rays_.size()) return nullptr;
    GlossyRay* const ray = new (&rays_[ray_count_++]) GlossyRay;
    ray->point = (first_point_ + static_cast<std::uint32_t>(&of - points_.data())) & 0x7FFFFFFFu;
    return ray;
}

void GlossyBuffer::clear_pixels(const PixelBox& box) {
    for (int y = box.y0; y < box.y1; ++y)
        std::fill(first_of_pixel_.begin() + static_cast<std::ptrdiff_t>(index(box.x0, y)),
                  first_of_pixel_.begin() + static_cast<std::ptrdiff_t>(index(box.x1 - 1, y)) + 1, kNone);
}

GlossyBuffer::Part& GlossyBuffer::begin(std::size_t number, const PixelBox& box, float share) {
    skip(number);
    parts_[number].box_ = box, parts_[number].share_ = share;
    return parts_[number];
}

void GlossyBuffer::skip(std::size_t number) {
    Part& part = parts_[number];
    if (part.linked_ > 0) clear_pixels(part.box_);
    part.point_count_ = part.ray_count_ = part.linked_ = 0;
}

void GlossyBuffer::link(Part& part) {
    const int width = part.box_.x1 - part.box_.x0;
    for (std::size_t i = part.linked_; i < part.ray_count_; ++i) {
        GlossyRay& ray = part.rays_[i];
        const GlossyPoint& of = points_[ray.point];
        ray.light = of.per_light * ray.light;
        const auto pixel = static_cast<int>(of.pixel);
        std::uint32_t& first =
            first_of_pixel_[index(part.box_.x0 + pixel % width, part.box_.y0 + pixel / width)];
        const std::size_t number = part.first_ray_ + i;
        starts_[number] = {of.point_m, of.normal, of.object, of.surface, of.back, first};
        first = static_cast<std::uint32_t>(number);
    }
    part.linked_ = part.ray_count_;
}

}  // namespace hilcam
