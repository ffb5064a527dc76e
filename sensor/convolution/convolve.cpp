#include "sensor/convolution/convolve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <vector>

#include "render/vocabulary/units.h"
#include "sensor/convolution/fourier.h"

namespace hilcam {
namespace {

struct AlignedFree {
    void operator()(float* block) const { ::operator delete[](block, std::align_val_t{64}); }
};
using Block = std::unique_ptr<float[], AlignedFree>;
Block allocate(std::size_t floats) {
    Block block(static_cast<float*>(::operator new[](floats * sizeof(float), std::align_val_t{64})));
    std::fill_n(block.get(), floats, 0.0f);
    return block;
}

// Returns the frequency of value i of n [cycles/px]: -1/2 .. 1/2, negative for the upper half of the values.
double frequency(int i, int n) { return static_cast<double>(i <= n / 2 ? i : i - n) / n; }

double along_axis(const FrameBlur& blur, double sigma_px, double cycles_px) {
    const double a = kPi * cycles_px * sigma_px;
    return std::exp(-2 * a * a) * (blur.axis ? blur.axis(std::abs(cycles_px)) : 1.0);
}

}  // namespace

struct Convolver::Implementation {
    // The image of one layer, and the factors for its spectrum.
    struct Layer {
        Block data;
        // Factors [frequencies along y, lanes() together][x][lane], scaled by 1 / (width height); imaginary
        // may be empty.
        std::vector<float> real, imaginary;
    };
    int width, height;
    std::unique_ptr<PlaneFourier> fourier;
    std::size_t lanes, groups, stride;  // groups of frequencies along y; floats per row
    std::vector<Layer> layers;
    // Scratch memory of one thread.
    struct Scratch {
        Block room, block, sum;
    };
    std::vector<Scratch> scratch;
    std::vector<float> along_u, along_v;  // factors of the blur, without the smear

    Implementation(int w, int h, const std::vector<Transfer>& transfers)
        : width(w),
          height(h),
          fourier(make_plane_fourier(w, h)),
          lanes(fourier->lanes()),
          groups((static_cast<std::size_t>(h / 2 + 1) + lanes - 1) / lanes),
          stride(PlaneFourier::stride(w)),
          along_u(static_cast<std::size_t>(w)),
          along_v(groups * lanes) {
        for (const Transfer& transfer : transfers) add_layer(transfer);
        scratch.resize(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
        for (Scratch& s : scratch)
            s = {allocate(PlaneFourier::room_floats(w, h)), allocate(PlaneFourier::block_floats(w)),
                 allocate(layers.size() > 1 ? PlaneFourier::block_floats(w) : std::size_t{1})};
    }
    void add_layer(const Transfer& transfer) {
        Layer layer{allocate(stride * static_cast<std::size_t>(height)), {}, {}};
        const std::size_t count = groups * lanes * static_cast<std::size_t>(width);
        layer.real.reserve(count);
        layer.imaginary.reserve(count);
        bool real = true;
        for (std::size_t group = 0; group < groups; ++group)
            for (int x = 0; x < width; ++x)
                for (std::size_t lane = 0; lane < lanes; ++lane) {
                    const std::complex<float> value =
                        factor(transfer, x, static_cast<int>(group * lanes + lane));
                    layer.real.push_back(value.real());
                    layer.imaginary.push_back(value.imag());
                    real = real && value.imag() == 0;
                }
        if (real) layer.imaginary = {};
        layers.push_back(std::move(layer));
    }
    std::complex<float> factor(const Transfer& transfer, int x, int v) const {
        if (v > height / 2) return 0;
        const std::complex<double> value =
            transfer(frequency(x, width), frequency(v, height)) / (static_cast<double>(width) * height);
        // At the image's Nyquist frequency, opposite frequencies coincide.
        const bool own_opposite = 2 * x == width || 2 * v == height;
        return {static_cast<float>(value.real()), own_opposite ? 0.0f : static_cast<float>(value.imag())};
    }

    float* plane(std::size_t layer) { return layers[layer].data.get(); }
    Scratch& mine() {
        return scratch[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())];
    }

    // Calls work(first) for the columns of every whole vector.
    template <typename Work>
    void for_columns(const Work& work) {
        const std::size_t step = PlaneFourier::kMaxLanes;
        const std::size_t count = (static_cast<std::size_t>(width) + step - 1) / step;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) work(i * step);
        });
    }
    void filter(std::size_t group, const SpectrumBlur* blur) {
        Scratch& s = mine();
        float* const result = layers.size() > 1 ? s.sum.get() : s.block.get();
        for (std::size_t l = 0; l < layers.size(); ++l) {
            float* const block = l == 0 ? result : s.block.get();
            fourier->rows_forward(plane(l), group * lanes, block, s.room.get());
            const std::size_t at = group * lanes * static_cast<std::size_t>(width);
            if (layers[l].imaginary.empty())
                fourier->multiply(block, layers[l].real.data() + at);
            else
                fourier->multiply(block, layers[l].real.data() + at, layers[l].imaginary.data() + at);
            if (l > 0) fourier->add(result, block);
        }
        if (blur) fourier->blur(result, group * lanes, *blur);
        fourier->rows_back(result, group * lanes, plane(0), s.room.get());
    }
    SpectrumBlur prepared(const FrameBlur& blur) {
        for (int x = 0; x < width; ++x)
            along_u[static_cast<std::size_t>(x)] =
                static_cast<float>(along_axis(blur, blur.sigma_px.x, frequency(x, width)));
        for (int v = 0; v <= height / 2; ++v)
            along_v[static_cast<std::size_t>(v)] =
                static_cast<float>(along_axis(blur, blur.sigma_px.y, frequency(v, height)));
        return {along_u, along_v, static_cast<float>(blur.smear_px.x), static_cast<float>(blur.smear_px.y)};
    }
};

int fft_size(int n) {
    for (int size = n + n % 2;; size += 2) {
        int rest = size;
        for (const int prime : {2, 3, 5, 7})
            while (rest % prime == 0) rest /= prime;
        if (rest == 1) return size;
    }
}

Convolver::Convolver(int width, int height, const std::vector<Transfer>& transfers)
    : width_(width),
      height_(height),
      implementation_(std::make_unique<Implementation>(width, height, transfers)) {}
Convolver::~Convolver() = default;
Convolver::Convolver(Convolver&&) noexcept = default;

int Convolver::layers() const { return static_cast<int>(implementation_->layers.size()); }
std::span<float> Convolver::row(int y, int layer) {
    Implementation& my = *implementation_;
    return {my.plane(static_cast<std::size_t>(layer)) + static_cast<std::size_t>(y) * my.stride,
            static_cast<std::size_t>(width_)};
}
std::span<const float> Convolver::row(int y, int layer) const {
    return const_cast<Convolver*>(this)->row(y, layer);
}

void Convolver::run(const FrameBlur& blur) {
    Implementation& my = *implementation_;
    std::optional<SpectrumBlur> factors;
    if (!blur.none()) factors = my.prepared(blur);
    my.for_columns([&](std::size_t first) {
        for (std::size_t layer = 0; layer < my.layers.size(); ++layer)
            my.fourier->columns_forward(my.plane(layer), first, my.mine().room.get());
    });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, my.groups), [&](const auto& range) {
        for (std::size_t group = range.begin(); group < range.end(); ++group)
            my.filter(group, factors ? &*factors : nullptr);
    });
    my.for_columns(
        [&](std::size_t first) { my.fourier->columns_back(my.plane(0), first, my.mine().room.get()); });
}

}  // namespace hilcam
