#pragma once
// The camera's address space: the bootstrap registers of GigE Vision 2.x, and the camera's own.

#include <cstdint>

namespace hilcam {

namespace bootstrap {
inline constexpr std::uint32_t kVersion = 0x0000, kDeviceMode = 0x0004, kMacHigh = 0x0008, kMacLow = 0x000C;
inline constexpr std::uint32_t kIpSupported = 0x0010, kIpCurrent = 0x0014;
inline constexpr std::uint32_t kIp = 0x0024, kMask = 0x0034, kGateway = 0x0044;
inline constexpr std::uint32_t kVendor = 0x0048, kModel = 0x0068, kDeviceVersion = 0x0088, kInfo = 0x00A8;
inline constexpr std::uint32_t kSerial = 0x00D8, kUserName = 0x00E8;
inline constexpr std::uint32_t kXmlUrl = 0x0200, kSecondXmlUrl = 0x0400, kInterfaces = 0x0600;
inline constexpr std::uint32_t kPersistentIp = 0x064C, kPersistentMask = 0x065C, kPersistentGateway = 0x066C;
inline constexpr std::uint32_t kLinkSpeed = 0x0670;
inline constexpr std::uint32_t kMessageChannels = 0x0900, kStreamChannels = 0x0904, kActionSignals = 0x0908;
inline constexpr std::uint32_t kActionDeviceKey = 0x090C, kActiveLinks = 0x0910;
inline constexpr std::uint32_t kStreamCapability = 0x092C, kMessageCapability = 0x0930,
                               kGvcpCapability = 0x0934;
inline constexpr std::uint32_t kHeartbeat = 0x0938, kTickFrequency = 0x093C, kTimestampControl = 0x0944,
                               kTimestamp = 0x0948;
inline constexpr std::uint32_t kDiscoveryDelay = 0x0950, kGvcpConfig = 0x0954, kPendingTimeout = 0x0958,
                               kSwitchoverKey = 0x095C;
inline constexpr std::uint32_t kGvspConfig = 0x0960, kLinkCapability = 0x0964, kLinkConfig = 0x0968,
                               kPtpStatus = 0x096C, kActionQueue = 0x0970;
inline constexpr std::uint32_t kControl = 0x0A00, kPrimaryPort = 0x0A04, kPrimaryIp = 0x0A14;
inline constexpr std::uint32_t kMessagePort = 0x0B00, kMessageAddress = 0x0B10, kMessageTimeout = 0x0B14,
                               kMessageRetries = 0x0B18, kMessageSourcePort = 0x0B1C;
inline constexpr std::uint32_t kStreamPort = 0x0D00, kPacketSize = 0x0D04, kPacketDelay = 0x0D08,
                               kStreamAddress = 0x0D18, kStreamSourcePort = 0x0D1C,
                               kStreamChannelCapability = 0x0D20, kStreamConfig = 0x0D24;
inline constexpr std::uint32_t kActionGroupKey = 0x9800, kActionGroupMask = 0x9804;

// Bits of kGvcpCapability and, where a client can switch them on, of kGvcpConfig.
namespace gvcp_can {
inline constexpr std::uint32_t kUserName = 1u << 31, kSerial = 1u << 30, kHeartbeatDisable = 1u << 29,
                               kLinkSpeed = 1u << 28, kPrimaryApplication = 1u << 27,
                               kExtendedStatus11 = 1u << 22, kSwitchover = 1u << 21,
                               kUnconditionalAction = 1u << 20, kPtp = 1u << 19, kExtendedStatus20 = 1u << 18,
                               kScheduledAction = 1u << 17, kAction = 1u << 6, kPendingAnswer = 1u << 5,
                               kEventData = 1u << 4, kEvent = 1u << 3, kPacketResend = 1u << 2,
                               kWriteMemory = 1u << 1, kConcatenation = 1u;
}
namespace gvcp_config {
inline constexpr std::uint32_t kHeartbeatDisable = 1u, kPendingAnswer = 1u << 1, kExtendedStatus11 = 1u << 2,
                               kUnconditionalAction = 1u << 3, kExtendedStatus20 = 1u << 18,
                               kPtpEnable = 1u << 19;
}
namespace stream_config {  // bits of kStreamConfig and kStreamChannelCapability
inline constexpr std::uint32_t kUnconditional = 1u << 1, kResendDestination = 1u << 3, kMultipart = 1u << 6;
}
inline constexpr std::uint32_t kExtendedIds = 1u << 30;                          // a bit of kGvspConfig
inline constexpr std::uint32_t kFireTest = 1u << 31, kDoNotFragment = 1u << 30;  // bits of kPacketSize
}  // namespace bootstrap

// The camera's own registers. Those of 8 bytes are doubles or 64-bit integers, the others 32-bit integers.
namespace feature_register {
// Image.
inline constexpr std::uint32_t kWidth = 0xA000, kHeight = 0xA004, kOffsetX = 0xA008, kOffsetY = 0xA00C;
inline constexpr std::uint32_t kPixelFormat = 0xA010, kPayloadSize = 0xA014, kSensorWidth = 0xA018,
                               kSensorHeight = 0xA01C, kWidthMax = 0xA020, kHeightMax = 0xA024;
inline constexpr std::uint32_t kOffsetXMax = 0xA028, kOffsetYMax = 0xA02C, kBinningX = 0xA030,
                               kBinningY = 0xA034, kReverseX = 0xA038, kReverseY = 0xA03C,
                               kTestPattern = 0xA040, kWidthRoom = 0xA044, kHeightRoom = 0xA048;
// Acquisition.
inline constexpr std::uint32_t kAcquisitionMode = 0xA100, kAcquisitionStart = 0xA104,
                               kAcquisitionStop = 0xA108, kAcquisitionAbort = 0xA10C,
                               kAcquisitionFrameCount = 0xA110, kBurstFrameCount = 0xA114,
                               kFrameRateEnable = 0xA118, kExposureMode = 0xA11C, kExposureAuto = 0xA120;
inline constexpr std::uint32_t kTriggerSelector = 0xA124, kTriggerMode = 0xA128, kTriggerSource = 0xA12C,
                               kTriggerSoftware = 0xA130, kTriggerActivation = 0xA134;
inline constexpr std::uint32_t kLineSelector = 0xA138, kLineMode = 0xA13C, kLineStatus = 0xA158,
                               kLineStatusAll = 0xA15C, kResultingFrameRate_hz = 0xA160;
inline constexpr std::uint32_t kExposureTime_us = 0xA140, kFrameRate_hz = 0xA148, kTriggerDelay_us = 0xA150;
// Analog.
inline constexpr std::uint32_t kGainSelector = 0xA180, kBlackLevelSelector = 0xA184, kGain_db = 0xA188,
                               kBlackLevel_dn = 0xA190;
// Device.
inline constexpr std::uint32_t kParamsLocked = 0xA200, kDeviceReset = 0xA204, kThroughputMode = 0xA208,
                               kTemperatureSelector = 0xA20C, kTemperature_c = 0xA210,
                               kThroughputLimit = 0xA218;
// Chunks, components, events, user sets.
inline constexpr std::uint32_t kChunkMode = 0xA300, kChunkSelector = 0xA304, kChunkEnable = 0xA308;
inline constexpr std::uint32_t kComponentSelector = 0xA310, kComponentEnable = 0xA314, kComponentId = 0xA318;
inline constexpr std::uint32_t kEventSelector = 0xA320, kEventNotification = 0xA324;
inline constexpr std::uint32_t kUserSetSelector = 0xA340, kUserSetLoad = 0xA344, kUserSetSave = 0xA348,
                               kUserSetDefault = 0xA34C;
inline constexpr std::uint32_t kActionSelector = 0xA360, kInterfaceSelector = 0xA364,
                               kStreamSelector = 0xA368;
// Statistics: 64-bit, in the order of GigeStreamStatistics.
inline constexpr std::uint32_t kStatistics = 0xA400;
// Lines, counters, timers.
inline constexpr std::uint32_t kTriggerDivider = 0xA600, kTriggerOverlap = 0xA604, kLineFormat = 0xA608,
                               kLineInverter = 0xA60C, kLineSource = 0xA610, kUserOutputSelector = 0xA614,
                               kUserOutputValue = 0xA618, kUserOutputValueAll = 0xA61C;
inline constexpr std::uint32_t kCounterSelector = 0xA640, kCounterEventSource = 0xA644,
                               kCounterEventActivation = 0xA648, kCounterResetSource = 0xA64C,
                               kCounterReset = 0xA650, kCounterValue = 0xA654, kCounterValueAtReset = 0xA658,
                               kCounterDuration = 0xA65C, kCounterStatus = 0xA660;
inline constexpr std::uint32_t kTimerSelector = 0xA680, kTimerTriggerSource = 0xA684,
                               kTimerTriggerActivation = 0xA688, kTimerReset = 0xA68C, kTimerStatus = 0xA690,
                               kTimerDuration_us = 0xA698, kTimerDelay_us = 0xA6A0, kTimerValue_us = 0xA6A8;
// PTP: what PtpDataSetLatch latches. Those from kPtpOffset_ns on have 8 bytes.
inline constexpr std::uint32_t kPtpDataSetLatch = 0xA700, kPtpLatchedStatus = 0xA704,
                               kPtpServoStatus = 0xA708, kPtpTimeScale = 0xA70C, kPtpUtcOffset_s = 0xA710,
                               kPtpSteps = 0xA714, kPtpOffset_ns = 0xA718, kPtpDelay_ns = 0xA720,
                               kPtpClockId = 0xA728, kPtpParentId = 0xA730, kPtpGrandmasterId = 0xA738;
// Sequencer.
inline constexpr std::uint32_t kSequencerMode = 0xA780, kSequencerConfigurationMode = 0xA784,
                               kSequencerFeatureSelector = 0xA788, kSequencerFeatureEnable = 0xA78C,
                               kSequencerSetSelector = 0xA790, kSequencerSetSave = 0xA794,
                               kSequencerSetLoad = 0xA798, kSequencerSetActive = 0xA79C,
                               kSequencerSetStart = 0xA7A0, kSequencerPathSelector = 0xA7A4,
                               kSequencerSetNext = 0xA7A8, kSequencerTriggerSource = 0xA7AC,
                               kSequencerTriggerActivation = 0xA7B0;
// Faults.
inline constexpr std::uint32_t kFaultSelector = 0xA500, kFaultEnable = 0xA504, kFaultClear = 0xA508,
                               kFaultClearAll = 0xA50C, kFaultActive = 0xA510;
inline constexpr std::uint32_t kFaultRate = 0xA518, kFaultValue = 0xA520, kFaultFromFrame = 0xA528,
                               kFaultFrames = 0xA530, kFaultDuration_s = 0xA538, kFaultCount = 0xA540;
}  // namespace feature_register

// The description, plain and zipped.
inline constexpr std::uint32_t kXmlAddress = 0x100000, kZipAddress = 0x200000;

}  // namespace hilcam
