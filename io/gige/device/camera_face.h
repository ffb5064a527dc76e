#pragma once
// A camera's registers as another camera's description has them (io/gige/face): reads and writes of the
// fields that the face table binds become reads and writes of hilcam's own features, everything else is
// memory. The standard's registers, below kFirstOfDevice, stay hilcam's own. One thread: the one that
// serves the control port.
//
// A client writes to a register: the camera sets the features whose bits change, and then runs the commands
// whose bits are set. If one of them is refused, the client gets an error and the memory keeps its old bytes;
// features that were set before it stay set. A row of the table may depend on the vendor's selectors; while
// they have other values, its register is plain memory. Formulas invert with rounding, so a number that
// hilcam took reads back as the number that was written.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/gige/device/gige_features.h"
#include "io/gige/device/gige_register_file.h"
#include "io/gige/face/face_files.h"
#include "io/gige/face/sparse_memory.h"

namespace hilcam {

class CameraFace {
  public:
    using Status = gvcp::Status;
    static constexpr std::uint32_t kFirstOfDevice = 0xA000;

    // own: hilcam's registers, which outlive this, as do the files. features: its features. xml_place,
    // xml_bytes: where own has the description. Throws InputError for a row with a feature that hilcam
    // never has, and for a table of a camera of another size.
    CameraFace(const CameraFaceFiles& files, GigeRegisterFile& own, const FeatureTable& features,
               std::uint32_t xml_place, std::size_t xml_bytes);

    // These are GigeRegisterFile's. Where the description has no register, memory reads as what was
    // written, at first 0.
    Status read(std::uint32_t address, std::span<std::uint8_t> out);
    Status write(std::uint32_t address, std::span<const std::uint8_t> data, bool locked, std::size_t& done);

    // Registers as after power-up.
    void reset();

  private:
    struct Row {
        const FaceRow* face = nullptr;
        const Feature* feature = nullptr;
        const Feature* selector = nullptr;
        std::uint64_t selected = 0;
        // Numbers of the register and of hilcam's feature, for choices.
        std::vector<std::pair<std::uint64_t, double>> values{};
    };
    using Words =
        std::multimap<std::uint32_t, std::size_t>;  // a word's number, and a row or a command that is in it

    void add_row(const FaceRow& row);
    bool shows(const Row& row) const;
    void settle_choices();
    const Feature* feature_of(const std::string& name, bool must_be) const;
    bool is_standard(std::uint32_t word_address) const;
    bool is_read_only(std::uint32_t address) const;
    std::vector<std::size_t> rows_in(const Words& words, std::uint32_t address, std::size_t bytes) const;

    bool holds(const Row& row) const;
    void compose(std::uint32_t address, std::span<std::uint8_t> out);
    std::uint64_t stored_bits(const RegisterField& field) const;
    std::uint64_t live_bits(const Row& row);
    double number_of_feature(const Feature& feature) const;
    double limit_of(const Feature& feature, FaceRow::Of of) const;
    Status set_feature(const Row& row, double number, bool locked);
    double number_in(const Row& row, std::uint64_t bits) const;
    Status set_row(const Row& row, std::uint64_t bits, bool locked);
    Status write_own(std::uint32_t address, std::uint64_t number, std::uint32_t bytes, bool locked);
    void select(const Row& row);
    Status write_words(std::uint32_t address, std::span<const std::uint8_t> data, bool locked);
    Status write_standard(std::uint32_t address, std::span<const std::uint8_t> data, bool locked);

    const CameraFaceFiles& files_;
    GigeRegisterFile& own_;
    const FeatureTable& features_;
    const std::uint32_t xml_place_;
    const std::size_t xml_bytes_;
    SparseMemory memory_;
    std::vector<Row> rows_;
    Words words_, clearing_;
    std::map<std::uint32_t, std::uint32_t> read_only_;  // begin, end
};

}  // namespace hilcam
