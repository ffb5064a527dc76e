// Features of the device itself: identity, user sets, faults on demand.

#include "io/gige/device/gige_fault_registers.h"
#include "io/gige/device/gige_features.h"

namespace hilcam {

namespace b = bootstrap;
namespace r = feature_register;

namespace {

Feature count(const char* name, std::uint32_t address, const char* meaning) {
    return integer64(name, address, meaning).between(0, kMax64).read_only();
}

}  // namespace

void add_device_features(FeatureTable& t) {
    t.add("DeviceControl",
          {
              fixed_entry("DeviceType", "Transmitter", "A source of pictures"),
              fixed_entry("DeviceScanType", "Areascan", "What a frame is"),
              fixed_entry("DeviceTLType", "GigEVision", "The interface"),
              fixed_number("DeviceSFNCVersionMajor", 2, "Of the Standard Features Naming Convention"),
              fixed_number("DeviceSFNCVersionMinor", 4, "Of the Standard Features Naming Convention"),
              fixed_number("DeviceSFNCVersionSubMinor", 0, "Of the Standard Features Naming Convention"),
              fixed_number("DeviceStreamChannelCount", 1, "Streams"),
              string("DeviceVendorName", b::kVendor, 32, "Maker"),
              string("DeviceModelName", b::kModel, 32, "Camera"),
              string("DeviceManufacturerInfo", b::kInfo, 48, "What it is"),
              string("DeviceVersion", b::kDeviceVersion, 32, "Version of the device"),
              string("DeviceFirmwareVersion", b::kDeviceVersion, 32, "Version of the program in it"),
              string("DeviceSerialNumber", b::kSerial, 16, "Unlike any other camera's on the network"),
              string("DeviceUserID", b::kUserName, 16, "A name of one's own").writable(),
              command("DeviceReset", r::kDeviceReset, "Control, stream and settings as after power-up"),
              enumeration("DeviceTemperatureSelector", r::kTemperatureSelector, counted({"Sensor"}), "Where")
                  .selects({"DeviceTemperature"}),
              real("DeviceTemperature", r::kTemperature_c, "Of the detector")
                  .between(-273.15, 1000)
                  .unit("C")
                  .read_only(),
              enumeration("DeviceLinkThroughputLimitMode", r::kThroughputMode, counted({"Off", "On"}),
                          "Whether the stream is held below a rate"),
              integer64("DeviceLinkThroughputLimit", r::kThroughputLimit, "That rate")
                  .between(100'000, 1e11)
                  .unit("Bps"),
              command("TimestampReset", b::kTimestampControl, "The device's clock begins at 0").bit(0),
              command("TimestampLatch", b::kTimestampControl, "Reads the clock").bit(1),
              integer64("TimestampLatchValue", b::kTimestamp, "The clock as it was read")
                  .between(0, kMax64)
                  .unit("ns")
                  .read_only(),
          });
    t.add("UserSetControl",
          {
              enumeration("UserSetSelector", r::kUserSetSelector,
                          counted({"Default", "UserSet1", "UserSet2"}), "A set of settings")
                  .selects({"UserSetLoad", "UserSetSave"}),
              command("UserSetLoad", r::kUserSetLoad, "Makes the set the present settings").locked(),
              command("UserSetSave", r::kUserSetSave, "Keeps the present settings while the program runs"),
              enumeration("UserSetDefault", r::kUserSetDefault, counted({"Default", "UserSet1", "UserSet2"}),
                          "What a reset begins with"),
          });
    const auto stat = [](std::uint32_t place) { return r::kStatistics + 8 * place; };
    t.add("StatisticsControl",
          {
              count("StatisticsFramesSent", stat(0), "Frames delivered"),
              count("StatisticsFramesDropped", stat(1), "Frames not sent: too slow, or a fault"),
              count("StatisticsPacketsSent", stat(2), "Packets sent for the first time"),
              count("StatisticsPacketsDropped", stat(3), "Packets that faults took away"),
              count("StatisticsResendRequests", stat(4), "PACKETRESEND commands"),
              count("StatisticsPacketsResent", stat(5), "Packets sent again"),
              count("StatisticsPacketsRefused", stat(6), "Packets asked for and not to be had"),
              count("StatisticsEventsDropped", stat(7), "Events without room or acknowledgement"),
          });
}

void add_fault_features(FeatureTable& t) {
    std::vector<EnumEntry> kinds;
    for (std::size_t i = 0; i < kAllFaults.size(); ++i)
        kinds.push_back({fault_feature_name(kAllFaults[i]), i});
    t.add("FaultControl",
          {
              enumeration("FaultSelector", r::kFaultSelector, kinds, "A kind of fault")
                  .selects({"FaultRate", "FaultValue", "FaultFromFrame", "FaultFrames", "FaultDuration",
                            "FaultCount", "FaultActive", "FaultEnable", "FaultClear"}),
              real("FaultRate", r::kFaultRate, "Share of what it strikes").between(0, 1),
              real("FaultValue", r::kFaultValue, "By kind: ms, bytes, MB/s, ...")
                  .between(-GigeFaultRegisters::kMaxValue, GigeFaultRegisters::kMaxValue),
              integer64("FaultFromFrame", r::kFaultFromFrame, "First frame; 0: at once")
                  .between(0, GigeFaultRegisters::kMaxFrames),
              integer64("FaultFrames", r::kFaultFrames, "Frames; 0: no end by frames")
                  .between(0, GigeFaultRegisters::kMaxFrames),
              real("FaultDuration", r::kFaultDuration_s, "From FaultEnable; 0: no end by time")
                  .between(0, 1e7)
                  .unit("s"),
              count("FaultCount", r::kFaultCount, "How often it has struck"),
              boolean("FaultActive", r::kFaultActive, "Whether it is in force").read_only(),
              command("FaultEnable", r::kFaultEnable, "Puts what is set up in force"),
              command("FaultClear", r::kFaultClear, "Ends this kind of fault"),
              command("FaultClearAll", r::kFaultClearAll, "Ends all faults"),
          });
}

}  // namespace hilcam
