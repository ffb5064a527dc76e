// Features of the interface: events, actions, time, GigE Vision's registers.

#include "io/gige/device/gige_features.h"
#include "io/gige/device/gige_messages.h"
#include "io/gige/device/gige_transport.h"

namespace hilcam {

namespace b = bootstrap;
namespace r = feature_register;

namespace {

constexpr double kMax32 = 4294967295.0;

Feature ip(const char* name, std::uint32_t address, const char* meaning) {
    return integer(name, address, meaning).between(0, kMax32).as("IPV4Address");
}

void add_actions(FeatureTable& t) {
    t.add("ActionControl",
          {
              integer("ActionDeviceKey", b::kActionDeviceKey, "Must be that of an ACTION command")
                  .between(0, kMax32)
                  .as("HexNumber")
                  .write_only(),
              fixed_number("ActionQueueSize", 16, "Scheduled actions that can wait"),
              integer("ActionSelector", r::kActionSelector, "An action signal")
                  .between(1, 1)
                  .selects({"ActionGroupKey", "ActionGroupMask"}),
              integer("ActionGroupKey", b::kActionGroupKey, "Must be that of an ACTION command")
                  .between(0, kMax32)
                  .as("HexNumber"),
              integer("ActionGroupMask", b::kActionGroupMask, "Must have a bit in common with the command's")
                  .between(0, kMax32)
                  .as("HexNumber"),
              boolean("ActionUnconditionalMode", b::kGvcpConfig, "Actions without a controller, too").bit(3),
          });
}

void add_gvcp(FeatureTable& t) {
    t.add(
        "TransportLayerControl",
        {
            integer("PayloadSize", r::kPayloadSize, "Bytes of a frame, chunks included")
                .between(1, kMax32)
                .unit("B")
                .read_only(),
            integer("TLParamsLocked", r::kParamsLocked, "1: the geometry is locked")
                .between(0, 1)
                .invisible(),
            integer("GevVersionMajor", b::kVersion, "Of GigE Vision")
                .between(0, 65535)
                .bits(31, 16)
                .read_only(),
            integer("GevVersionMinor", b::kVersion, "Of GigE Vision")
                .between(0, 65535)
                .bits(15, 0)
                .read_only(),
            boolean("GevDeviceModeIsBigEndian", b::kDeviceMode, "Registers' order").bit(31).read_only(),
            integer("GevNumberOfInterfaces", b::kInterfaces, "Network interfaces").between(1, 4).read_only(),
            integer("GevInterfaceSelector", r::kInterfaceSelector, "An interface").between(0, 0),
            integer("GevMessageChannelCount", b::kMessageChannels, "Message channels")
                .between(0, 1)
                .read_only(),
            integer("GevStreamChannelCount", b::kStreamChannels, "Stream channels").between(1, 1).read_only(),
            integer64("GevMACAddress", b::kMacHigh, "Of the interface")
                .between(0, 281474976710655.0)
                .as("MACAddress")
                .read_only(),
            integer("GevLinkSpeed", b::kLinkSpeed, "Of the interface; 0: not known")
                .between(0, kMax32)
                .unit("Mbps")
                .read_only(),
            boolean("GevCurrentIPConfigurationLLA", b::kIpCurrent, "Link-local addresses").bit(2),
            boolean("GevCurrentIPConfigurationDHCP", b::kIpCurrent, "DHCP").bit(1).read_only(),
            boolean("GevCurrentIPConfigurationPersistentIP", b::kIpCurrent, "A persistent address").bit(0),
            ip("GevCurrentIPAddress", b::kIp, "Address").read_only(),
            ip("GevCurrentSubnetMask", b::kMask, "Its mask").read_only(),
            ip("GevCurrentDefaultGateway", b::kGateway, "Its gateway").read_only(),
            ip("GevPersistentIPAddress", b::kPersistentIp, "To be used at a start; not followed here"),
            ip("GevPersistentSubnetMask", b::kPersistentMask, "Its mask"),
            ip("GevPersistentDefaultGateway", b::kPersistentGateway, "Its gateway"),
            enumeration("GevCCP", b::kControl,
                        {{"OpenAccess", 0},
                         {"ExclusiveAccess", 1},
                         {"ControlAccess", 2},
                         {"ControlAccessSwitchoverActive", 6}},
                        "Who has control"),
            integer("GevPrimaryApplicationSocket", b::kPrimaryPort, "The controller's port")
                .between(0, 65535)
                .read_only(),
            ip("GevPrimaryApplicationIPAddress", b::kPrimaryIp, "The controller's address").read_only(),
            integer("GevPrimaryApplicationSwitchoverKey", b::kSwitchoverKey, "Of who may take over")
                .between(0, 65535)
                .bits(15, 0)
                .write_only(),
            integer("GevHeartbeatTimeout", b::kHeartbeat, "Silence that ends a client's control")
                .between(500, 600000)
                .unit("ms"),
            boolean("GevGVCPHeartbeatDisable", b::kGvcpConfig, "Silence does not end control").bit(0),
            boolean("GevGVCPPendingAck", b::kGvcpConfig, "Slow answers are announced").bit(1),
            integer("GevGVCPPendingTimeout", b::kPendingTimeout, "The slowest answer")
                .between(0, kMax32)
                .unit("ms")
                .read_only(),
            boolean("GevGVCPExtendedStatusCodesVersion1_1", b::kGvcpConfig, "Status codes of GEV 1.1").bit(2),
            boolean("GevGVCPExtendedStatusCodesVersion2_0", b::kGvcpConfig, "Status codes of GEV 2.0")
                .bit(18),
            integer64("GevTimestampTickFrequency", b::kTickFrequency, "Ticks per second")
                .between(1e9, 1e9)
                .unit("Hz")
                .read_only(),
            command("GevTimestampControlLatch", b::kTimestampControl, "Reads the clock").bit(1),
            command("GevTimestampControlReset", b::kTimestampControl, "The clock begins at 0").bit(0),
            integer64("GevTimestampValue", b::kTimestamp, "The clock as it was read")
                .between(0, kMax64)
                .read_only(),
        });
}

void add_channels(FeatureTable& t) {
    t.add(
        "TransportLayerControl",
        {
            integer("GevMCPHostPort", b::kMessagePort, "Where events go; 0: nowhere")
                .between(0, 65535)
                .bits(15, 0),
            ip("GevMCDA", b::kMessageAddress, "Where events go"),
            integer("GevMCTT", b::kMessageTimeout, "Until an event is repeated; 0: never")
                .between(0, 60000)
                .unit("ms"),
            integer("GevMCRC", b::kMessageRetries, "Repetitions of an event").between(0, 100),
            integer("GevMCSP", b::kMessageSourcePort, "Where events come from").between(0, 65535).read_only(),
            integer("GevStreamChannelSelector", r::kStreamSelector, "A stream").between(0, 0),
            integer("GevSCPHostPort", b::kStreamPort, "Where the stream goes; 0: closed")
                .between(0, 65535)
                .bits(15, 0),
            integer("GevSCPInterfaceIndex", b::kStreamPort, "Its interface")
                .between(0, 3)
                .bits(19, 16)
                .read_only(),
            enumeration("GevSCPDirection", b::kStreamPort, {{"Transmitter", 0}, {"Receiver", 1}}, "Its way")
                .bit(31)
                .read_only(),
            ip("GevSCDA", b::kStreamAddress, "Where the stream goes; may be a multicast group"),
            integer("GevSCSP", b::kStreamSourcePort, "Where the stream comes from")
                .between(0, 65535)
                .read_only(),
            integer("GevSCPSPacketSize", b::kPacketSize, "IP, UDP, GVSP headers included")
                .between(GigeTransport::kMinPacketBytes, GigeTransport::kMaxPacketBytes)
                .every(GigeTransport::kPacketStep)
                .unit("B")
                .bits(15, 0)
                .locked(),
            // Readable and writable like the features beside it; otherwise clients write the size as 0 with
            // it.
            command("GevSCPSFireTestPacket", b::kPacketSize, "Sends a packet of that size")
                .bit(31)
                .writable(),
            boolean("GevSCPSDoNotFragment", b::kPacketSize, "Packets are not divided on their way").bit(30),
            boolean("GevSCPSBigEndian", b::kPacketSize, "Order of pixels' bytes").bit(29).read_only(),
            integer("GevSCPD", b::kPacketDelay, "Between packets").between(0, 1e9).unit("ns"),
            boolean("GevSCCFGUnconditionalStreaming", b::kStreamConfig, "Goes on without a controller")
                .bit(1),
            boolean("GevSCCFGPacketResendDestination", b::kStreamConfig,
                    "Packets asked for again go to who asked")
                .bit(3),
            boolean("GevSCCFGMultiPartEnabled", b::kStreamConfig, "Multi-part frames").bit(6).locked(),
            enumeration("GevGVSPExtendedIDMode", b::kGvspConfig, counted({"Off", "On"}), "64-bit block ids")
                .bit(30)
                .locked(),
        });
}

}  // namespace

void add_event_features(FeatureTable& t) {
    std::vector<EnumEntry> kinds;
    kinds.reserve(std::size(kGigeEvents));
    for (const GigeEvent& event : kGigeEvents) kinds.push_back({event.name, kinds.size()});
    t.add(
        "EventControl",
        {
            enumeration("EventSelector", r::kEventSelector, kinds, "An event").selects({"EventNotification"}),
            enumeration("EventNotification", r::kEventNotification, counted({"Off", "On"}),
                        "Whether it is told on the message channel"),
        });
    // The place of an item's time, and of its data, depends on the length of the block ids.
    t.formulas.push_back({"EventTimePlace", "(LONG = 1) ? 16 : 8", "LONG", "GevGVSPExtendedIDModeReg"});
    t.formulas.push_back({"EventDataPlace", "(LONG = 1) ? 24 : 16", "LONG", "GevGVSPExtendedIDModeReg"});
    for (const GigeEvent& event : kGigeEvents) {
        const std::string name = std::string("Event") + event.name;
        const std::string port = name + "Port";
        t.ports.push_back({.name = port, .event = event.id});
        const auto value = [&](const char* what, const char* meaning, const char* place) {
            Feature f = integer64((name + what).c_str(), 0, meaning).between(0, kMax64).read_only();
            f.port = port;
            f.address_feature = place;
            return f;
        };
        t.add("EventControl", {fixed_number(name.c_str(), event.id, "Its number"),
                               value("Timestamp", "When it happened, device clock", "EventTimePlace")});
        if (event.id >= gvcp::Event::kFirstOfDevice)
            t.add("EventControl",
                  {value("FrameID", event.of_frame ? "Of the frame; 0: of none" : "0: no frame",
                         "EventDataPlace")});
    }
}

void add_transport_features(FeatureTable& t) {
    add_actions(t);
    add_ptp_features(t);
    add_gvcp(t);
    add_channels(t);
}

}  // namespace hilcam
