#pragma once
// The camera's features, once: their SFNC names, registers, access and limits. The GenICam XML is generated
// from this table and the device checks writes against it.

#include <cstdint>
#include <string>
#include <vector>

#include "io/camera_control.h"

namespace hilcam {

// Registers of the GigE Vision bootstrap block that the device acts on.
namespace bootstrap {
inline constexpr std::uint32_t kVersion = 0x0000, kDeviceMode = 0x0004, kMacHigh = 0x0008, kMacLow = 0x000C;
inline constexpr std::uint32_t kIpSupported = 0x0010, kIpCurrent = 0x0014, kIp = 0x0024, kMask = 0x0034,
                               kGateway = 0x0044;
inline constexpr std::uint32_t kVendor = 0x0048, kModel = 0x0068, kDeviceVersion = 0x0088, kInfo = 0x00A8;
inline constexpr std::uint32_t kSerial = 0x00D8, kUserName = 0x00E8, kXmlUrl = 0x0200, kInterfaces = 0x0600;
inline constexpr std::uint32_t kStreamChannels = 0x0904, kGvcpCapability = 0x0934, kHeartbeat = 0x0938;
inline constexpr std::uint32_t kTickFrequency = 0x093C, kTimestampControl = 0x0944, kTimestamp = 0x0948;
inline constexpr std::uint32_t kGvcpConfig = 0x0954, kControl = 0x0A00, kPrimaryPort = 0x0A04,
                               kPrimaryIp = 0x0A14;
inline constexpr std::uint32_t kStreamPort = 0x0D00, kPacketSize = 0x0D04, kPacketDelay = 0x0D08;
inline constexpr std::uint32_t kStreamAddress = 0x0D18, kStreamSourcePort = 0x0D1C;
}  // namespace bootstrap

// The camera's own registers.
namespace feature_register {
inline constexpr std::uint32_t kWidth = 0xA000, kHeight = 0xA004, kOffsetX = 0xA008, kOffsetY = 0xA00C;
inline constexpr std::uint32_t kPixelFormat = 0xA010, kAcquisitionMode = 0xA014, kAcquisitionStart = 0xA018;
inline constexpr std::uint32_t kAcquisitionStop = 0xA01C, kAcquisitionFrameCount = 0xA020,
                               kPayloadSize = 0xA024;
inline constexpr std::uint32_t kSensorWidth = 0xA028, kSensorHeight = 0xA02C, kParamsLocked = 0xA030;
inline constexpr std::uint32_t kExposureMode = 0xA034, kFrameRateEnable = 0xA038;
inline constexpr std::uint32_t kExposureTime_us = 0xA100, kGain_db = 0xA108, kFrameRate_hz = 0xA110;
}  // namespace feature_register

inline constexpr std::uint32_t kXmlAddress = 0x20000;
enum AcquisitionMode : std::uint32_t { kContinuous = 0, kSingleFrame = 1, kMultiFrame = 2 };

struct EnumEntry {
    std::string name;
    std::uint32_t value;
};

struct Feature {
    enum class Kind { kInteger, kFloat, kEnumeration, kCommand, kBoolean, kString } kind;
    enum class Access { kRead, kReadWrite, kWrite } access;
    const char* category;
    const char* name;
    std::uint32_t address;
    std::uint32_t bytes;
    double least = 0, most = 0;
    double step = 1;
    std::string unit{};
    std::vector<EnumEntry> entries{};
    int lsb = -1, msb = -1;  // bits of a masked register, GenICam's big-endian numbering (0 is the highest)
    bool locked_while_streaming = false;
};

std::vector<Feature> gige_features(const CameraLimits& limits);

}  // namespace hilcam
