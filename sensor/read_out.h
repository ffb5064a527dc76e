#pragma once
// The read-out turns the charge of a row of pixels into a row of numbers, in the order of a real sensor.
//
//   full well, nonlinearity          charge as the amplifier sees it
//   read, reset, row, 1/f, telegraph noise; fixed offsets      [e-]
//   filters along the row            electronics.h
//   gain, black level, converter     DN
//
// 1/f noise runs along the array in the order of its pixels. It is a sum of octaves, each constant over 2^k
// pixels (Voss & Clarke, J. Acoust. Soc. Am. 63, 258, 1978): it has the same power in every octave from one
// cycle per frame to half a cycle per pixel, and any pixel's value can be computed alone.

#include <span>
#include <vector>

#include "render/vocabulary/random.h"
#include "sensor/camera_model.h"
#include "sensor/electronics.h"
#include "sensor/fixed_pattern.h"

namespace hilcam {

// A row of pixels during read-out.
struct ReadOutRow {
    int y = 0;                        // row of the array, or of the binned array
    std::uint32_t sensor_row = 0;     // key of the row's own noise
    std::span<float> charge_e;        // modified during read-out
    std::span<const float> deviates;  // standard normal, one for each pixel
    std::span<const float> offset_e;  // fixed pattern; may be empty
    double gain_dn_e = 1;
    double black_level_dn = 0;
    int charges = 1;         // number of detector pixels with combined charge
    int charges_across = 1;  // number of these that are side by side
};

class ReadOut {
  public:
    explicit ReadOut(const CameraModel& camera);
    // telegraph: pixels in the row that is read; with binned charge, in the first of its rows. Numbers are
    // not companded, because cameras that bin numbers do so first. Loop, any thread; so are the functions
    // below.
    void read(const ReadOutRow& row, std::span<const TelegraphPixel> telegraph, RandomKey key,
              std::span<std::uint16_t> dn) const;
    void compand(std::span<std::uint16_t> dn) const { converter_.compand(dn); }
    // Returns the largest sum of binned numbers.
    std::uint32_t max_sum_dn() const { return max_sum_dn_; }
    const RowFilter& filter() const { return filter_; }

  private:
    void add_flicker(int y, RandomKey key, std::span<float> charge_e) const;
    void add_telegraph(std::span<const TelegraphPixel> pixels, int charges_across, RandomKey key,
                       std::span<float> charge_e) const;

    float full_well_e_, a2_, a3_;
    float pixel_noise_e_;  // read and reset noise
    float row_noise_e_;
    std::uint64_t telegraph_frames_;
    int flicker_octaves_ = 0;
    float flicker_octave_e_ = 0;
    RowFilter filter_;
    Converter converter_;
    std::uint32_t max_sum_dn_;
};

}  // namespace hilcam
