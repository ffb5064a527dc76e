#pragma once
// The read-out turns the charge of a row of pixels into a row of numbers, in the order of a sensor.
//
//   full well, nonlinearity          charge as the amplifier sees it
//   read, reset, row, 1/f, telegraph noise; fixed offsets      [e-]
//   filters along the row            electronics.h
//   gain, black level, converter     DN
//
// 1/f noise runs along the array in the order of its pixels: a sum of octaves, each constant over 2^k pixels
// (Voss & Clarke, J. Acoust. Soc. Am. 63, 258, 1978): the same power in every octave from one cycle per frame
// to half a cycle per pixel, and any pixel's value can be computed alone.

#include <span>
#include <vector>

#include "render/vocabulary/random.h"
#include "sensor/camera_model.h"
#include "sensor/electronics.h"
#include "sensor/fixed_pattern.h"

namespace hilcam {

// A row as it is read.
struct ReadOutRow {
    int y = 0;                        // row of the array, or of the binned one
    std::uint32_t sensor_row = 0;     // keys the row's own noise
    std::span<float> charge_e;        // changed on the way
    std::span<const float> deviates;  // standard normal, one for each pixel
    std::span<const float> offset_e;  // fixed; may be empty
    double gain_dn_e = 1;
    double black_level_dn = 0;
    int charges = 1;         // pixels of the detector whose charge has met in one
    int charges_across = 1;  // and how many of them side by side
};

class ReadOut {
  public:
    explicit ReadOut(const CameraModel& camera);
    // telegraph: pixels of the array's row that is read; where charge has met, of the first of its rows. Numbers are not
    // companded: cameras that bin numbers do so first. Loop, any thread, as is what follows.
    void read(const ReadOutRow& row, std::span<const TelegraphPixel> telegraph, RandomKey key,
              std::span<std::uint16_t> dn) const;
    void compand(std::span<std::uint16_t> dn) const { converter_.compand(dn); }
    // Returns the greatest sum of numbers.
    std::uint32_t max_sum_dn() const { return max_sum_dn_; }
    const RowFilter& filter() const { return filter_; }

  private:
    void add_flicker(int y, RandomKey key, std::span<float> charge_e) const;
    void add_telegraph(std::span<const TelegraphPixel> pixels, int charges_across, RandomKey key,
                       std::span<float> charge_e) const;

    float full_well_e_, a2_, a3_;
    float pixel_noise_e_;  // read and reset
    float row_noise_e_, telegraph_e_;
    std::uint64_t telegraph_frames_;
    int flicker_octaves_ = 0;
    float flicker_octave_e_ = 0;
    RowFilter filter_;
    Converter converter_;
    std::uint32_t max_sum_dn_;
};

}  // namespace hilcam
