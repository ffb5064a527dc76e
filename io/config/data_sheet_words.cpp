#include "io/config/data_sheet_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace hilcam {
namespace {

struct SheetRow {
    std::string_view words;  // words with one meaning, each between two spaces
    DataSheetWord is;
};

// Conversions: 1 pA is 6.2415e6 e-/s, and 1 cm^2 is 1e8 um^2; quantum efficiency from A/W is h c / (e
// lambda), 1.23984 um (CODATA 2018). Gains and noises in the words of EMVA 1288, release 4.0.
constexpr std::array kSheetRows = {
    SheetRow{
        " conversion_gain cg charge_conversion_factor charge_to_voltage conversion_factor "
        "output_responsivity ",
        {"camera.gain_dn_e", "in DN per electron: uV/e- times 2^bits over the converter's full scale in uV"}},
    SheetRow{" system_gain overall_system_gain k_factor camera_gain inverse_gain ",
             {"camera.gain_dn_e", "EMVA 1288's K in DN/e-; its inverse in e-/DN is gain_e_dn"}},
    SheetRow{" gain analog_gain analogue_gain digital_gain iso ",
             {"camera.gain_db", "what the camera is set to, in dB; DN per electron are gain_dn_e"}},
    SheetRow{
        " fwc full_well full_well_capacity full_well_charge full_well_depth linear_full_well pixel_full_well "
        "saturation saturation_capacity saturation_charge saturation_level charge_capacity well_depth ",
        {"camera.full_well_e", "in electrons: ke- times 1000"}},
    SheetRow{" qe peak_qe qe_peak quantum_yield quantum_efficiency spectral_qe ",
             {"camera.quantum_efficiency",
              "a share and no percentage, as number or [[wavelength_um, value], ...]"}},
    SheetRow{" spectral_response spectral_responsivity responsivity photo_response ",
             {"camera.quantum_efficiency", "A/W times 1.24 over the wavelength in um"}},
    SheetRow{" sensitivity light_sensitivity absolute_sensitivity absolute_sensitivity_threshold ",
             {"",
              "there is no key: it follows from quantum_efficiency, pitch_um, fill_factor, gain_dn_e and "
              "read_noise_e"}},
    SheetRow{
        " dynamic_range dr intrascene_dynamic_range ",
        {"",
         "there is no key: it follows from full_well_e and read_noise_e ('hilcam check CAMERA' says it)"}},
    SheetRow{" snr max_snr snr_max maximum_snr signal_to_noise_ratio peak_snr ",
             {"", "there is no key: it follows from full_well_e ('hilcam check CAMERA' says it)"}},
    SheetRow{" read_noise readout_noise read_out_noise rn temporal_dark_noise dark_noise temporal_noise "
             "temporal_read_noise noise_floor dark_temporal_noise noise sigma_d ",
             {"camera.read_noise_e", "in electrons: DN times gain_e_dn"}},
    SheetRow{" ktc ktc_noise reset_noise ", {"camera.reset_noise_e", "in electrons"}},
    SheetRow{" dark_current dark_signal dark_current_density dark_rate ",
             {"camera.dark_current_e_s",
              "in electrons a second and pixel, at dark_reference_c: pA/cm2 times 0.0624 times pitch_um^2"}},
    SheetRow{" dark_current_doubling doubling_temperature dark_doubling dark_current_doubling_temperature ",
             {"camera.dark_doubling_k", "temperature rise that doubles the dark current"}},
    SheetRow{" prnu photo_response_nonuniformity photo_response_non_uniformity photoresponse_nonuniformity "
             "pixel_response_nonuniformity prnu1288 ",
             {"camera.prnu_fraction", "a share: percent over 100"}},
    SheetRow{" dsnu dark_signal_nonuniformity dark_signal_non_uniformity fpn fixed_pattern_noise dsnu1288 ",
             {"camera.dsnu_e", "in electrons: DN times gain_e_dn; rows and columns have fixed_pattern"}},
    SheetRow{" crosstalk pixel_crosstalk ",
             {"camera.crosstalk_fraction", "share for each of the four neighbours"}},
    SheetRow{
        " pixel_size pixel_pitch pixel pixel_width pixel_height pitch cell_size unit_cell_size pixelsize ",
        {"camera.pitch_um", "in micrometres, from centre to centre"}},
    SheetRow{
        " resolution image_size sensor_resolution pixels number_of_pixels array_size active_pixels format "
        "effective_pixels megapixels ",
        {"camera.width_px", "and height_px: active columns and rows"}},
    SheetRow{" sensor_size optical_format sensor_format sensor_diagonal diagonal active_area image_circle ",
             {"camera.width_px", "and height_px; the size follows by pitch_um"}},
    SheetRow{" bit_depth adc adc_bits adc_resolution bits_per_pixel digitization digitisation quantization "
             "quantisation ad_converter ",
             {"camera.bits", "of the converter; container_bits are those in memory"}},
    SheetRow{" black_level blacklevel offset bias bias_level pedestal dark_offset dark_level ",
             {"camera.offset_dn", "in DN"}},
    SheetRow{" fps frame_rate framerate frames_per_second max_frame_rate frame_frequency ",
             {"camera.frame_rate_hz", "in frames a second; the limits are frame_rate_range_hz"}},
    SheetRow{" exposure exposure_time integration_time shutter_time shutter_speed t_int tint ",
             {"camera.exposure_ms", "in milliseconds; the limits are exposure_range_ms"}},
    SheetRow{" shutter_type shutter_kind shutter_mode global_shutter rolling_shutter electronic_shutter ",
             {"camera.shutter", "as shutter: {kind: global}, or rolling, frame_transfer, line_scan"}},
    SheetRow{" line_time row_time line_period row_readout_time line_rate ",
             {"camera.shutter", "as shutter: {kind: rolling, line_time_us: 20}"}},
    SheetRow{
        " f_stop fnumber f_no fno f_ratio focal_ratio aperture f working_f_number relative_aperture iris ",
        {"camera.f_number", "focal length over the aperture's diameter: f/2.8 is 2.8"}},
    SheetRow{" focal_length focallength efl effective_focal_length ",
             {"camera.focal_length_mm", "in millimetres"}},
    SheetRow{" fov field_of_view hfov vfov afov angle_of_view ifov ",
             {"camera.focal_length_mm",
              "0.001 width_px pitch_um / (2 tan(half the field across)); ifov: 0.001 pitch_um over it "
              "in rad"}},
    SheetRow{" lens_transmission lens_transmittance transmittance optical_transmission t_stop ",
             {"camera.transmission", "a share, as number or curve; or t_number in its place"}},
    SheetRow{" wavefront_error wfe rms_wavefront_error ",
             {"camera.wavefront_rms_nm", "rms, in nanometres: waves times the wavelength"}},
    SheetRow{" mtf lens_mtf ",
             {"camera.measured_mtf", "as measured_mtf: {mtf: [[cycles_mm, modulation], ...]}"}},
    SheetRow{" linearity linearity_error non_linearity ",
             {"camera.nonlinearity", "as [a2, a3]: charge is read as q (1 + a2 x + a3 x^2)"}},
    SheetRow{
        " cte cti charge_transfer_efficiency charge_transfer_inefficiency ",
        {"camera.ccd", "as ccd: {parallel_inefficiency: 1e-5, serial_inefficiency: 1e-5}, each 1 - CTE"}},
    SheetRow{" color colour color_mode bayer bayer_pattern cfa color_filter_array colour_filter "
             "colour_filter_array "
             "filter_pattern pixel_format color_pattern rggb grbg gbrg bggr ",
             {"camera.color_filter",
              "as color_filter: RGGB (also GRBG, GBRG, BGGR, mono), or filters of your own"}},
    SheetRow{" operating_temperature sensor_temperature temperature detector_temperature ",
             {"camera.temperature_c", "of the detector, in degrees Celsius"}},
    SheetRow{" roi region_of_interest aoi window ", {"camera.window_px", "as [left, top, width, height]"}},
    SheetRow{" model model_name camera_model sensor_name sensor ",
             {"camera.name", "the model that clients see"}},
};

// A sheet's units, as they end a key.
constexpr std::string_view kSheetUnits =
    " e ke dn adu lsb um mm nm m ms us s sec hz khz fps db dbm mv uv v uv_e pa cm2 percent pct px pixel bit "
    "bits deg mp k c "
    "electrons per p ";

bool has_word(std::string_view list, std::string_view word) {
    return list.find(" " + std::string(word) + " ") != std::string_view::npos;
}

// Returns "full_well_capacity" for "Full-Well Capacity".
std::string key_of_sheet(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte))
            out += static_cast<char>(std::tolower(byte));
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    if (!out.empty() && out.back() == '_') out.pop_back();
    return out;
}

}  // namespace

const DataSheetWord* data_sheet_word(std::string_view key) {
    std::string word = key_of_sheet(key);
    while (!word.empty()) {
        for (const SheetRow& row : kSheetRows)
            if (has_word(row.words, word)) return &row.is;
        const std::size_t at = word.rfind('_');
        if (at == std::string::npos || !has_word(kSheetUnits, std::string_view(word).substr(at + 1))) break;
        word.resize(at);
    }
    return nullptr;
}

}  // namespace hilcam
