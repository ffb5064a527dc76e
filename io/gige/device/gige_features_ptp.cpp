// Features of PTP, by SFNC 2.5's names and by those that GigE Vision cameras had before (GevIEEE1588...:
// Basler ace, FLIR Blackfly S).

#include "io/gige/device/gige_features.h"

namespace hilcam {

namespace b = bootstrap;
namespace r = feature_register;

namespace {

std::vector<EnumEntry> ptp_states() {
    return {{"Initializing", 1}, {"Faulty", 2},  {"Disabled", 3},     {"Listening", 4}, {"PreMaster", 5},
            {"Master", 6},       {"Passive", 7}, {"Uncalibrated", 8}, {"Slave", 9}};
}

Feature latched_states(const char* name, const char* meaning) {
    return enumeration(name, r::kPtpLatchedStatus, ptp_states(), meaning).bits(3, 0).read_only();
}
Feature live_states(const char* name, const char* meaning) {
    return enumeration(name, b::kPtpStatus, ptp_states(), meaning).bits(3, 0).read_only();
}
// An EUI-64 may have its highest bit set and is negative then, as on other cameras.
Feature clock_id(const char* name, std::uint32_t address, const char* meaning) {
    Feature f = integer64(name, address, meaning).as("HexNumber").read_only();
    f.is_signed = true;
    return f;
}
Feature nanoseconds(const char* name, std::uint32_t address, const char* meaning) {
    Feature f = integer64(name, address, meaning).unit("ns").read_only();
    f.is_signed = true;
    return f;
}
// 254 is "unknown" in IEEE 1588-2008, table 6.
Feature clock_accuracy() {
    Feature f =
        fixed_entry("PtpClockAccuracy", "Unknown", "Of the device as a grandmaster, which it never is");
    f.value = f.entries[0].value = 254;
    return f;
}
Feature whole_seconds(const char* name, std::uint32_t address, const char* meaning) {
    Feature f = integer(name, address, meaning).between(-32768, 32767).unit("s").read_only();
    f.is_signed = true;
    return f;
}

}  // namespace

void add_ptp_features(FeatureTable& t) {
    t.add("PtpControl",
          {
              boolean("PtpEnable", b::kGvcpConfig,
                      "The clock follows a PTP master or, with source tai, CLOCK_TAI")
                  .bit(19),
              clock_accuracy(),
              live_states("PtpStatus",
                          "State of the port, now. With source tai what the machine's kernel says of its "
                          "clock: Listening: not synchronised; Uncalibrated: no offset of TAI to UTC; Slave: "
                          "both are there"),
              command("PtpDataSetLatch", r::kPtpDataSetLatch, "Latches the values below, all of one instant"),
              enumeration("PtpServoStatus", r::kPtpServoStatus, counted({"Unknown", "Locked"}),
                          "Latched: whether the clock follows its master")
                  .read_only(),
              nanoseconds("PtpOffsetFromMaster", r::kPtpOffset_ns,
                          "Latched: device minus master, as measured last"),
              nanoseconds("PtpMeanPropagationDelay", r::kPtpDelay_ns, "Latched: mean delay of the path"),
              clock_id("PtpClockID", r::kPtpClockId, "Latched: identity of the device's clock"),
              clock_id("PtpParentClockID", r::kPtpParentId,
                       "Latched: identity of the master on this network; 0: none"),
              clock_id("PtpGrandmasterClockID", r::kPtpGrandmasterId,
                       "Latched: identity of the grandmaster; 0: none"),
              enumeration("PtpTimeScale", r::kPtpTimeScale,
                          counted({"Device", "Monotonic", "Arbitrary", "UTC", "TAI"}),
                          "Latched: the clock's scale")
                  .read_only(),
              whole_seconds("PtpCurrentUtcOffset", r::kPtpUtcOffset_s,
                            "Latched: TAI minus UTC by the master, valid or not"),
              integer("PtpSteps", r::kPtpSteps, "Latched: how often the clock has stepped")
                  .between(0, 4294967295.0)
                  .read_only(),
          });
    t.add("TransportLayerControl",
          {
              boolean("GevIEEE1588", b::kGvcpConfig, "As PtpEnable").bit(19),
              live_states("GevIEEE1588Status", "As PtpStatus"),
              command("GevIEEE1588DataSetLatch", r::kPtpDataSetLatch, "As PtpDataSetLatch"),
              latched_states("GevIEEE1588StatusLatched", "Latched: PtpStatus"),
              nanoseconds("GevIEEE1588OffsetFromMaster", r::kPtpOffset_ns, "As PtpOffsetFromMaster (Basler)"),
              nanoseconds("GevIEEE1588OffsetFromMasterLatched", r::kPtpOffset_ns,
                          "As PtpOffsetFromMaster (FLIR)"),
              clock_id("GevIEEE1588ClockId", r::kPtpClockId, "As PtpClockID"),
              clock_id("GevIEEE1588ParentClockId", r::kPtpParentId, "As PtpParentClockID (Basler)"),
              clock_id("GevIEEE1588ParentClockIdLatched", r::kPtpParentId, "As PtpParentClockID (FLIR)"),
          });
}

}  // namespace hilcam
