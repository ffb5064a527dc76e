// Features of the image and its acquisition.

#include "io/gige/device/gige_features.h"
#include "io/gige/device/gige_image.h"
#include "io/gige/stream/gige_stream.h"
#include "io/system/wire_format.h"

namespace hilcam {

namespace r = feature_register;

namespace {

std::vector<EnumEntry> pixel_formats(const CameraLimits& l) {
    std::vector<EnumEntry> entries;
    for (const WireFormat format : formats_of(l.color_pattern))
        entries.push_back({pfnc_name(format, l.color_pattern), pfnc_code(format, l.color_pattern)});
    return entries;
}

// Returns Software, Line0, the action; then Line0's other names, and the other inputs.
std::vector<EnumEntry> trigger_sources(const FeatureTable& t) {
    std::vector<EnumEntry> entries = counted({"Software", "Line0", "Action1"});
    for (std::size_t i = 1; i < t.lines.size(); ++i) entries.push_back({t.lines[i], entries.size()});
    for (const EnumEntry& line : own_lines(t.plan, false)) entries.push_back(line);
    return entries;
}

}  // namespace

void add_image_features(FeatureTable& t) {
    const CameraLimits& l = t.limits;
    const double w = l.width, h = l.height, step = GigeImage::step(l);
    const auto max_binning = static_cast<double>(l.max_binning);
    const bool no_binning = l.max_binning <= 1;
    t.add("ImageFormatControl",
          {
              integer("SensorWidth", r::kSensorWidth, "Columns").between(w, w).unit("px").read_only(),
              integer("SensorHeight", r::kSensorHeight, "Rows").between(h, h).unit("px").read_only(),
              integer("WidthMax", r::kWidthMax, "Columns after binning").between(1, w).unit("px").read_only(),
              integer("HeightMax", r::kHeightMax, "Rows after binning").between(1, h).unit("px").read_only(),
              integer("Width", r::kWidth, "Of the window")
                  .between(step, "WidthRoom")
                  .every(step)
                  .unit("px")
                  .locked(),
              integer("Height", r::kHeight, "Of the window")
                  .between(step, "HeightRoom")
                  .every(step)
                  .unit("px")
                  .locked(),
              integer("OffsetX", r::kOffsetX, "Left edge of the window")
                  .between(0, "OffsetXMax")
                  .every(step)
                  .unit("px")
                  .locked(),
              integer("OffsetY", r::kOffsetY, "Upper edge of the window")
                  .between(0, "OffsetYMax")
                  .every(step)
                  .unit("px")
                  .locked(),
              integer("BinningHorizontal", r::kBinningX, "Columns added up to one: 1, 2, 4, ...")
                  .between(1, max_binning)
                  .read_only(no_binning)
                  .locked(),
              integer("BinningVertical", r::kBinningY, "Rows added up to one: 1, 2, 4, ...")
                  .between(1, max_binning)
                  .read_only(no_binning)
                  .locked(),
              enumeration("PixelFormat", r::kPixelFormat, pixel_formats(l), "Of the stream").locked(),
              enumeration("TestPattern", r::kTestPattern,
                          counted({"Off", "Black", "White", "GreyHorizontalRamp", "GreyVerticalRamp",
                                   "GreyHorizontalRampMoving"}),
                          "A picture in place of what the camera sees"),
          });
    if (l.reversible)
        t.add("ImageFormatControl", {
                                        boolean("ReverseX", r::kReverseX, "Left and right change places"),
                                        boolean("ReverseY", r::kReverseY, "Top and bottom change places"),
                                    });
    if (t.multipart)
        t.add(
            "ImageFormatControl",
            {
                enumeration("ComponentSelector", r::kComponentSelector, counted({"Intensity", "Confidence"}),
                            "A part of multipart frames")
                    .selects({"ComponentEnable", "ComponentIDValue"}),
                boolean("ComponentEnable", r::kComponentEnable,
                        "Whether it is among them. Confidence is 0 where the DN is 0 or full scale, else 255")
                    .locked(),
                integer("ComponentIDValue", r::kComponentId, "Its id in the stream")
                    .between(1, 6)
                    .read_only(),
            });
    t.add("", {
                  integer("WidthRoom", r::kWidthRoom, "").between(1, w).read_only(),
                  integer("HeightRoom", r::kHeightRoom, "").between(1, h).read_only(),
                  integer("OffsetXMax", r::kOffsetXMax, "").between(0, w).read_only(),
                  integer("OffsetYMax", r::kOffsetYMax, "").between(0, h).read_only(),
              });
}

void add_acquisition_features(FeatureTable& t) {
    const CameraLimits& l = t.limits;
    t.add(
        "AcquisitionControl",
        {
            enumeration("AcquisitionMode", r::kAcquisitionMode,
                        counted({"Continuous", "SingleFrame", "MultiFrame"}),
                        "When the stream ends by itself")
                .locked(),
            command("AcquisitionStart", r::kAcquisitionStart, "Begins the stream"),
            command("AcquisitionStop", r::kAcquisitionStop, "Ends the stream"),
            command("AcquisitionAbort", r::kAcquisitionAbort, "Ends the stream at once"),
            integer("AcquisitionFrameCount", r::kAcquisitionFrameCount, "Frames of a MultiFrame stream")
                .between(1, 65535)
                .locked(),
            integer("AcquisitionBurstFrameCount", r::kBurstFrameCount, "Frames of a FrameBurstStart trigger")
                .between(1, static_cast<double>(l.max_burst_frames)),
            real("AcquisitionFrameRate", r::kFrameRate_hz, "Without triggers, and inside a burst")
                .between(l.min_frame_rate_hz, l.max_frame_rate_hz)
                .unit("Hz")
                .read_only(l.frame_rate_is_own)
                .locked_by("AcquisitionFrameRateFixed"),
            boolean("AcquisitionFrameRateEnable", r::kFrameRateEnable, "Off: as fast as the camera can")
                .read_only(l.frame_rate_is_own),
            real("AcquisitionResultingFrameRate", r::kResultingFrameRate_hz,
                 "What exposure and shutter leave of AcquisitionFrameRate")
                .between(0, l.max_frame_rate_hz)
                .unit("Hz")
                .read_only(),
            real("ResultingFrameRate", r::kResultingFrameRate_hz,
                 "AcquisitionResultingFrameRate by another name")
                .between(0, l.max_frame_rate_hz)
                .unit("Hz")
                .read_only(),
            enumeration("ExposureMode", r::kExposureMode,
                        l.has_trigger_width() ? std::vector<EnumEntry>{{"Timed", 1}, {"TriggerWidth", 2}}
                                              : std::vector<EnumEntry>{{"Timed", 1}},
                        "What ends the exposure; TriggerWidth: the end of the pulse on a line that triggers "
                        "single frames")
                .read_only(!l.has_trigger_width()),
            enumeration("ExposureAuto", r::kExposureAuto,
                        l.has_automatic_exposure ? counted({"Off", "Continuous", "Once"}) : counted({"Off"}),
                        "Whether the camera chooses its exposure; Once: until it has found it, then Off"),
            real("ExposureTime", r::kExposureTime_us, "Of the next frame that has not begun")
                .between(l.min_exposure_s * 1e6, l.max_exposure_s * 1e6)
                .unit("us")
                .read_only(l.exposure_is_own)
                .locked_by("ExposureAutoReg"),
            enumeration("TriggerSelector", r::kTriggerSelector,
                        counted({"FrameStart", "FrameBurstStart", "AcquisitionStart"}),
                        "What a trigger starts; one of them can be on. AcquisitionStart: the stream's frames "
                        "wait for one trigger")
                .selects({"TriggerMode", "TriggerSource", "TriggerSoftware", "TriggerActivation",
                          "TriggerDivider", "TriggerDelay", "TriggerOverlap"}),
            enumeration("TriggerMode", r::kTriggerMode, counted({"Off", "On"}),
                        "Whether frames wait for a trigger"),
            enumeration("TriggerSource", r::kTriggerSource, trigger_sources(t), "Where triggers come from"),
            command("TriggerSoftware", r::kTriggerSoftware, "A trigger"),
            enumeration("TriggerActivation", r::kTriggerActivation,
                        l.has_trigger_levels()
                            ? counted({"RisingEdge", "FallingEdge", "AnyEdge", "LevelHigh", "LevelLow"})
                            : counted({"RisingEdge", "FallingEdge", "AnyEdge"}),
                        "Of a line; while a level holds, frames follow one another"),
            integer("TriggerDivider", r::kTriggerDivider, "Each n-th edge of a line is a trigger")
                .between(1, static_cast<double>(l.max_trigger_divider)),
            real("TriggerDelay", r::kTriggerDelay_us, "From a trigger to its first frame")
                .between(0, l.max_trigger_delay_s * 1e6)
                .unit("us"),
            enumeration("TriggerOverlap", r::kTriggerOverlap,
                        l.can_wait_for_readout() ? counted({"Off", "ReadOut"})
                                                 : std::vector<EnumEntry>{{"ReadOut", 1}},
                        "Off: missed before the readout's end")
                .read_only(!l.can_wait_for_readout()),
        });
    t.formulas.push_back(
        {"AcquisitionFrameRateFixed", "ENABLED = 0", "ENABLED", "AcquisitionFrameRateEnableReg"});
    t.add("AnalogControl",
          {
              enumeration("GainSelector", r::kGainSelector, counted({"All"}), "Which gain").selects({"Gain"}),
              real("Gain", r::kGain_db, "Over the camera's own")
                  .between(l.min_gain_db, l.max_gain_db)
                  .unit("dB")
                  .read_only(l.gain_is_own),
              enumeration("BlackLevelSelector", r::kBlackLevelSelector, counted({"All"}), "Which black level")
                  .selects({"BlackLevel"}),
              real("BlackLevel", r::kBlackLevel_dn, "DN of no light")
                  .between(0, l.max_black_level_dn)
                  .unit("DN"),
          });
}

// --- chunks

namespace {

// Chunk, its name in ChunkSelector, the feature with its value.
struct ChunkRow {
    Chunk chunk;
    const char* selector;
    Feature value;
};

std::vector<ChunkRow> chunk_rows(const CameraLimits& l) {
    const auto u32 = [](const char* name, const char* meaning) {
        return integer(name, 0, meaning).between(0, 4294967295.0);
    };
    const auto u64 = [](const char* name, const char* meaning) {
        return integer64(name, 0, meaning).between(0, 9.2e18);
    };
    const auto i64 = [](const char* name, const char* meaning) {
        Feature f = integer64(name, 0, meaning).between(-9.2e18, 9.2e18);
        f.is_signed = true;
        return f;
    };
    const double any = 1e30;
    return {
        {Chunk::kFrameId, "FrameID", u64("ChunkFrameID", "The frame's number in this run of the camera")},
        {Chunk::kTimestamp, "Timestamp", u64("ChunkTimestamp", "Middle of the exposure, device clock")},
        {Chunk::kExposureTime, "ExposureTime",
         real("ChunkExposureTime", 0, "Exposure").between(0, any).unit("us")},
        {Chunk::kGain, "Gain", real("ChunkGain", 0, "Gain").between(-any, any).unit("dB")},
        {Chunk::kBlackLevel, "BlackLevel",
         real("ChunkBlackLevel", 0, "Black level").between(-any, any).unit("DN")},
        {Chunk::kOffsetX, "OffsetX", u32("ChunkOffsetX", "Left edge of the window")},
        {Chunk::kOffsetY, "OffsetY", u32("ChunkOffsetY", "Upper edge of the window")},
        {Chunk::kWidth, "Width", u32("ChunkWidth", "Columns")},
        {Chunk::kHeight, "Height", u32("ChunkHeight", "Rows")},
        {Chunk::kPixelFormat, "PixelFormat",
         enumeration("ChunkPixelFormat", 0, pixel_formats(l), "Of the frame")},
        {Chunk::kPoseSequence, "PoseSequence",
         u32("ChunkPoseSequence", "Of the newest pose command that the frame shows")},
        {Chunk::kPoseTime, "PoseTime", i64("ChunkPoseTime", "That command's time tag, simulated TAI in ns")},
        {Chunk::kExposureMid, "ExposureMid",
         i64("ChunkExposureMid", "Middle of the exposure, simulated TAI in ns")},
        {Chunk::kTriggerSequence, "TriggerSequence",
         u32("ChunkTriggerSequence", "Of the command that asked for the frame")},
        {Chunk::kFaults, "Faults",
         u64("ChunkFaults",
             "Faults that struck the frame: bit n is FaultSelector n; 59 light not kept yet, 60 time stood, "
             "61 no poses came, 62 "
             "time tags went back")},
        {Chunk::kSequencerSet, "SequencerSetActive",
         u32("ChunkSequencerSetActive", "The sequencer's set that the frame used; 0 without sequencer")},
    };
}

}  // namespace

void add_chunk_features(FeatureTable& t) {
    std::vector<EnumEntry> kinds;
    std::vector<Feature> values;
    for (ChunkRow& row : chunk_rows(t.limits)) {
        const auto place = static_cast<std::uint32_t>(row.chunk);
        kinds.push_back({row.selector, place});
        row.value.port = row.value.name + "Port";
        row.value.access = Feature::Access::kRead;
        t.ports.push_back({.name = row.value.port, .chunk = kChunkIdBase + place});
        values.push_back(std::move(row.value));
    }
    t.add("ChunkDataControl",
          {
              boolean("ChunkModeActive", r::kChunkMode, "Whether chunks follow the pixels").locked(),
              enumeration("ChunkSelector", r::kChunkSelector, kinds, "A chunk").selects({"ChunkEnable"}),
              boolean("ChunkEnable", r::kChunkEnable, "Whether it is among them").locked(),
          });
    t.add("ChunkDataControl", std::move(values));
}

}  // namespace hilcam
