// Mistakes that people make in a scenario, and what they are told: the place, what was found, what helps.
// None is silent.

#include <gmock/gmock.h>

#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "emulator/check/check_command.h"
#include "emulator/check/scenario_verdict.h"
#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/config/config_keys.h"
#include "io/config/renamed_keys.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// Line 1 is the first.
constexpr const char* kScenario =
    "name: base\n"
    "time_utc: 2026-03-20T12:00:00Z\n"
    "origin: {kind: earth_fixed, longitude_deg: 0, height_km: 35786}\n"
    "camera:\n"
    "  width_px: 64\n"
    "  height_px: 64\n"
    "  pitch_um: 10\n"
    "  focal_length_mm: 6.4\n"
    "  f_number: 8\n"
    "  quantum_efficiency: 0.5\n"
    "  transmission: 0.01\n"
    "  full_well_e: 20000\n"
    "  gain_dn_e: 0.2\n"
    "  bits: 12\n"
    "camera_pose:\n"
    "  position_m: [4, 0, 0]\n"
    "  attitude: look_at\n"
    "  look_at_m: [0, 0, 0]\n"
    "  up: [0, 0, 1]\n"
    "objects:\n"
    "  - name: plate\n"
    "    mesh: plate.obj\n"
    "    pose: {position_m: [0, 0, 0]}\n"
    "mode: free_run\n"
    "outputs: {files: {folder: frames}}\n";

struct Mistake {
    const char* name;
    int line;           // that it is made in
    const char* text;   // in that line's place
    const char* place;  // "2:11": where the message finds it; empty: a warning
    const char* words;
    std::vector<std::pair<int, const char*>> others = {};  // further lines
};

const Mistake kMistakes[] = {
    // YAML itself.
    {"Tab", 5, "\twidth_px: 64", "5:10", "tabs are not allowed"},
    {"Indent", 6, "    height_px: 64", "6:14", "the keys of one mapping begin in one column"},
    {"Colon", 7, "  pitch_um:10", "8:18", "a space comes after the colon"},
    {"OpenBracket", 16, "  position_m: [4, 0, 0", "17:11",
     "not YAML: end of sequence flow not found; the [ of line 16 is not closed"},
    // Keys.
    {"UnknownKey", 9, "  f_numbr: 8", "9:3", "camera.f_numbr: unknown key; nearest known key: f_number"},
    {"OtherUnit", 8, "  focal_length_m: 0.0064", "8:3", "its unit here is another: focal_length_mm"},
    {"KeyTwice", 9, "  width_px: 64", "9:3", "camera.width_px: the key is given twice"},
    {"KeyMissing", 8, "", "5:3", "camera.focal_length_mm: the key is missing"},
    {"SectionMisspelt", 20, "object:", "20:1", "unknown key; nearest known key: objects"},
    {"KeyOfAnotherSection", 1, "exposure_ms: 5", "1:1",
     "unknown key; there is camera.exposure_ms; known keys"},
    // Keys that contradict each other.
    {"CurveAndBaffle", 11,
     "  outside_light: {transmittance: [[10, 1.0e-4], [20, 1.0e-6]], baffle_angle_deg: 30}", "11:82",
     "a measured transmittance has the baffle in it; accepted: one of the two"},
    {"MagnitudeOfHapke", 24, "moon: {law: hapke, measured_magnitude: true}", "24:40",
     "which has its own scale"},
    {"HeightsWithoutMap", 24, "moon: {law: hapke, height_zero_m: -10000}", "24:35",
     "has no effect without height_map"},
    // Values.
    {"WordForNumber", 9, "  f_number: wide", "9:13", "found 'wide'; accepted: a number"},
    {"UnitInValue", 8, "  focal_length_mm: 6.4 mm", "8:20", "found '6.4 mm'; accepted: a number"},
    {"Percent", 10, "  quantum_efficiency: 50", "10:23", "in percent? here it would be 0.5"},
    {"FractionOfAPixel", 5, "  width_px: 64.5", "5:13", "found '64.5'; accepted: a whole number"},
    {"Negative", 7, "  pitch_um: -10", "7:13", "found '-10'"},
    {"TwoNumbers", 16, "  position_m: [4, 0]", "16:15", "found a list of 2; accepted: a list of 3 numbers"},
    {"UnknownChoice", 24, "mode: lock_step", "24:7",
     "found 'lock_step'; accepted: free_run | triggered | lockstep"},
    {"FlagByWord", 25, "earth: {visible: maybe}", "25:18", "found 'maybe'; accepted: true or false"},
    {"NotOfNormOne", 17, "  attitude_wxyz: [1, 1, 0, 0]", "17:18", "found a quaternion of norm 1.414"},
    {"TextForSection", 23, "    pose: here", "23:11",
     "accepted: a mapping, or the path of a file that holds it"},
    {"TextForListItem", 20, "objects: [plate]\nlamps:", "20:11",
     "objects.0: found 'plate'; accepted: a mapping"},
    {"SectionForList", 20, "objects: {name: plate}\nlamps:", "20:10", "accepted: a list of mappings"},
    {"NoSuchList", 20, "objects: plates.yaml\nlamps:", "20:10",
     "accepted: a list of mappings, or the path of a file that holds it; "},
    {"DataSheetsWord", 11, "  full_well_capacity: 13500", "11:3",
     "a data sheet's word? here it is full_well_e: in electrons"},
    {"Nanometres", 25, "spectrum_edges_um: [400, 950]", "25:21",
     "found '400'; accepted: a number, 0.2 to 20"},
    {"CurveInNanometres", 10, "  quantum_efficiency: [[400, 0.3], [900, 0.5]]", "10:25",
     "in nanometres? here it would be 0.4"},
    // Time.
    {"NoDate", 2, "time_utc: noon", "2:11", "time_utc: "},
    {"NoSuchMonth", 2, "time_utc: 2026-13-01T00:00:00Z", "2:11", "time_utc: "},
    {"EventWithoutDate", 25, "events: [{at_utc: tomorrow, do: [ping]}]", "25:19", "events.0.at_utc: "},
    // Files.
    {"NoSuchMesh", 22, "    mesh: spacecraft.glb", "22:11", "objects.0.mesh: "},
    {"NoSuchKindOfMesh", 22, "    mesh: scenario.yaml", "22:11", "accepted: .glb .gltf .obj .stl .ply"},
    {"NoSuchJoint", 23, "    joints: [{node: wing}]", "22:11", "no triangle under a node 'wing'"},
    {"NoSuchShippedPart", 25, "quality: realtme", "25:10",
     "or the name of a shipped one ('hilcam list qualities'); nearest: realtime; "},
    {"NoSuchSection", 4, "camera: sheet.yaml\nterrain:", "4:9", "sheet.yaml: no such file"},
    // Attitudes.
    {"UpAlongTheSight", 19, "  up: [-1, 0, 0]", "19:7", "camera_pose.up: is parallel to the line of sight"},
    {"LooksAtItself", 18, "  look_at_m: [4, 0, 0]", "18:14", "camera_pose.look_at_m: is equal to position_m"},
    {"UpWithoutEffect", 17, "  attitude: nadir", "18:14",
     "camera_pose.look_at_m: has no effect with attitude: nadir; accepted: attitude: look_at"},
    {"TwoAttitudes", 17, "  attitude_wxyz: [1, 0, 0, 0]", "17:18", "has no effect with look_at_m and up"},
    {"MotionOfAnotherKind", 23,
     "    motion: {kind: fixed, kepler: {semi_major_axis_km: 7000, true_anomaly_deg: 0}}", "23:35",
     "objects.0.motion.kepler: has no effect: kind is not kepler"},
    {"PoseAndMotion", 24, "camera_motion: {kind: fixed}", "24:16",
     "either 'camera_pose' or 'camera_motion'; found both"},
    {"PlaceBesideACenter", 3, "origin: {kind: earth_center, longitude_deg: 0}", "3:45",
     "origin.longitude_deg: has no effect with kind: earth_center"},
    {"SunWithoutFreeSpace", 25, "sun: {direction: [1, 0, 0]}", "25:18", "sun.direction: has no effect"},
    {"FreeSpaceWithoutSun", 3, "origin: {kind: free}", "1:1", "sun: has no position of the Sun"},
    {"TwoFormsOfAttitude", 17, "  attitude_radec_deg: [1, 2, 0]\n  attitude_mrp: [0, 0, 0]", "17:23",
     "camera_pose.attitude_radec_deg: found besides 'attitude_mrp'"},
    {"KeyframesWithoutAnAttitude", 23,
     "    motion: {kind: keyframes, keyframes: [{at_s: 0, position_m: [0, 0, 0]}], attitude: {law: "
     "keyframes}}",
     "23:94", "is keyframes, and none of them has an attitude"},
    // Ports.
    {"TwoOnOnePort", 25, "outputs: {truth: {port: 5733}, preview: {port: 5733}}", "25:25",
     "found TCP '127.0.0.1:5733', where outputs.preview.port listens, too"},
    // Lines.
    {"LinesInLockstep", 24, "mode: lockstep\nlines: {udp: {}}", "25:8",
     "lines: found with 'mode: lockstep'; accepted: free_run, triggered"},
    {"ApidOfIdlePackets", 25, "outputs: {packets: {apid: 2047}}", "25:27",
     "outputs.packets.apid: found '2047'; accepted: a whole number, 0 to 2046"},
    {"PacketOfNoSize", 25, "outputs: {packets: {packet_bytes: 100}}", "25:35",
     "outputs.packets.packet_bytes: found '100'; accepted: a whole number, 128 to 65542"},
    {"DatagramTooLong", 25, "outputs: {packets: {packet_bytes: 65542}}", "25:35",
     "outputs.packets.packet_bytes: found 65542; accepted: 65507 at most in a UDP datagram"},
    {"PacketsToAName", 25, "outputs: {packets: {address: ground.example}}", "25:30",
     "outputs.packets.address: found 'ground.example'; accepted: an IPv4 address"},
    {"PacketsToNoSocket", 25, "outputs: {packets: {transport: unix}}", "25:20",
     "outputs.packets.path: found none; accepted: the path of a Unix socket"},
    {"PortOfAFile", 25, "outputs: {packets: {transport: file, port: 5020}}", "25:44",
     "only transport udp, tcp or tcp_server has it"},
    {"CompressionUnknown", 25, "outputs: {packets: {payload: ccsds_122}}", "25:30",
     "outputs.packets.payload: found 'ccsds_122'"},
    {"LineOfTwoWays", 24, "lines: {inputs: [{line: 1}], outputs: [{line: 1}]}", "24:47",
     "lines.outputs.0.line: found 1, which is an input; accepted: a line for each"},
    {"LineOfNoCamera", 24, "lines: {outputs: [{line: 1, camera: 2}]}", "24:37",
     "lines.outputs.0.camera: found 2; accepted: 1 to 1"},
    {"LineThatIsAnothersName", 25, "lines: {inputs: [{line: 2}]}\noutputs: {gige: {lines: [Line2]}}", "26:25",
     "outputs.gige.lines: found 'Line2', which is a line of 'lines'"},
    {"PinAndPulse", 24, "lines: {inputs: [{gpio: /dev/gpiochip0, pps: /dev/pps0}]}", "24:46",
     "lines.inputs.0.pps: found beside gpio"},
    // What may be meant.
    {"NoOrigin", 16, "  position_m: [0.001, 0, 0]\norigin_:", "17:1",
     "unknown key; nearest known key: origin"},
    {"CameraInTheEarth", 3, "seed: 1", "", "camera 1 begins inside the body 'earth'"},
    {"RuleForNoSurface", 23, "    materials: {surfaces: [{name: gold, material: {}}]}", "",
     "no surface matches its material rules for 'gold'"},
    {"LockstepForNobody", 24, "mode: lockstep", "", "nothing can request a frame"},
    {"TriggeredByNobody", 24, "mode: triggered", "", "nothing can trigger a frame"},
    {"LampOnNothing", 24,
     "lamps:\n  - {name: a, intensity_w_sr_um: 3}\n  - {name: b, on: plat, intensity_w_sr_um: 3}", "26:19",
     "lamps.1.on: lamp 'b': on: found 'plat'; accepted: camera, plate"},
    {"EventOfNothing", 24, "events:\n  - {when: {object: plat, light: lit}, do: expose}", "25:5",
     "events.0: object: found 'plat'"},
    {"FallingEdges", 24, "spectrum_edges_um: [0.6, 0.4]", "24:20",
     "spectrum_edges_um: spectral bins: edge 0.4"},
    {"OneNameForTwo", 23, "  - {name: plate, mesh: plate.obj}", "", "another object is also named 'plate'"},
    {"FaultForNobody", 24, "faults: [{kind: packet_drop}]", "", "has no effect without outputs.gige"},
    {"Millimetres", 22, "    mesh: plate.obj\n    scale: 10000", "", "the file is probably in millimetres"},
    {"LooksAway", 18, "  look_at_m: [8, 0, 0]", "", "object 'plate' is behind the camera"},
    {"Kilometres", 22, "    mesh: plate.obj\n    scale: 0.001", "", "is its scale too small?"},
    {"WindowBesideTheSensor", 14, "  bits: 12\n  window_px: [60, 0, 10, 10]", "15:14",
     "camera.window_px: reaches outside the sensor of 64 x 64"},
    {"KeyOfAnotherModel", 22,
     "    mesh: plate.obj\n    materials: {surfaces: [{name: a, material: {model: glass, roughness: 0.2}}]}",
     "23:74",
     "objects.0.materials.surfaces.0.material.roughness: has no effect with model glass; accepted: "
     "refractive_index, transmittance, temperature_k, source, model"},
    {"LineTimeOfAGlobalShutter", 14, "  bits: 12\n  shutter: {line_time_us: 30}", "",
     "camera.shutter.line_time_us: has no effect with kind: global"},
    {"SecondCameraForNobody", 24,
     "more_cameras: [{camera: {width_px: 8, height_px: 8, pitch_um: 10, focal_length_mm: 6.4, f_number: 8, "
     "quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12}}]",
     "", "more_cameras.0.outputs: camera 2 has none"},
    {"NoSuchCatalogue", 24, "stars: {catalogue: none.csv}", "24:20: stars.catalogue",
     "none.csv: no such file; accepted: a star catalogue in CSV"},
    {"StarsWithoutACatalogue", 24, "stars: {faintest_magnitude: 6}", "", "stars: there are none without"},
    {"ExposureLongerThanThePeriod", 14, "  bits: 12\n  exposure_ms: 200", "",
     "camera.frame_rate_hz is 30: camera.exposure_ms of 200 with the shutter's rows allows 5 frames/s at "
     "most"},
    {"GainAHundredTimesTooHigh", 13, "  gain_dn_e: 20", "", "camera.gain_dn_e or gain_db is too high"},
    {"GainAHundredTimesTooLow", 13, "  gain_dn_e: 0.002", "", "camera.gain_dn_e or gain_db is too low"},
    {"FullWellInThousands", 12, "  full_well_e: 20", "", "is the data sheet's value in ke-?"},
    {"BlackLevelCutsTheNoise", 14, "  bits: 12\n  read_noise_e: 20", "",
     "camera.offset_dn is 0, and the noise in the dark 4 DN"},
    {"LineTwice", 25, "outputs: {gige: {interface: 127.0.0.1, lines: [Line1, Line0]}}", "25:47",
     "lines: found 'Line0'; accepted: names that differ"},
    {"LineOfSigns", 25, "outputs: {gige: {interface: 127.0.0.1, lines: ['Line 1']}}", "25:47",
     "lines: found 'Line 1'; accepted: letters and digits"},
    {"MapOfTwoPlaces", 20,
     "terrain: {material: x.yaml, globe: {body: moon, maps: [{file: a.png, bounds_deg: [0, 0, 1, 1], "
     "longitudes: west}]}}\nobjects:",
     "20:108", "longitudes: has no effect with bounds_deg"},
    {"TableWithoutUse", 14, "  bits: 12\n  converter: {companding_table: [[0, 0], [4095, 255]]}", "15:33",
     "companding_table: has no effect without companding: table"},
    {"NoSuchInterface", 25, "outputs: {gige: {interface: nowhere0}}", "",
     "interface 'nowhere0' does not exist"},
    // Values and places that are in range, and not meant.
    {"NadirWithoutOrigin",
     3,
     "seed: 1",
     "23:11",
     "objects.0.pose: the attitude nadir points to the centre of the body",
     {{23, "    pose: {attitude: nadir}"}}},
    {"BlackLevelNearTheEnd", 13, "  gain_dn_e: 0.2\n  offset_dn: 4000", "",
     "camera.offset_dn of 4000 leaves 95 DN of 4095 for light"},
    {"EventMisspelt", 24, "events: [{at_s: 1, do: expos}]", "24:24",
     "events.0.do: found 'expos': unknown subcommand 'expos'; nearest:"},
    {"EventWithAnOptionAsKey", 24, "events: [{at_s: 1, object: 1, do: joint}]", "24:20",
     "events.0.object: unknown key; an option of a command stands in its"},
    {"FocalLengthThousandfold", 8, "  focal_length_mm: 6400", "",
     "object 'plate' fills the picture: it is 2.03 deg large"},
    {"PitchWithoutItsPoint", 7, "  pitch_um: 58.6", "",
     "camera.pitch_um is 58.6: cameras have pixels of 0.5 to 40 um"},
    {"ExposureHundredthOfIt", 14, "  bits: 12\n  exposure_ms: 0.1", "",
     "object 'plate' is dark: about 41 DN of 4095, 1 % of full scale"},
    {"ExposureHundredfold", 14, "  bits: 12\n  exposure_ms: 1000", "",
     "object 'plate' saturates: about 102 times the range of a pixel"},
    {"HeightInMetres", 3, "origin: {kind: earth_fixed, longitude_deg: 0, height_km: 35786000}", "",
     "that is 0.24 au from the body 'earth'; in metres? here it would be 35786"},
    {"FolderThatCannotBeWritten", 25, "outputs: {files: {folder: /proc/x}}", "",
     "outputs.files.folder: found '/proc/x', and nothing can be written in '/proc'"},
    {"TwoDocuments", 25, "outputs: {files: {folder: frames}}\n---\nname: two", "26:1",
     "a second document ('---') begins here; accepted: one a file"},
    {"InsideOut", 22, "    mesh: inside.obj", "", "objects.0.mesh: 'inside.obj' is inside out"},
    {"NoSuchMtl", 22, "    mesh: grey.obj", "", "names the materials 'grey.mtl', and there is no such file"},
    // Units, missing parts, swapped words.
    {"PoseInKilometres",
     3,
     "origin: {kind: earth_center}",
     "",
     "give positions in metres if these are kilometres",
     {{16, "  position_m: [42164, 0, 0]"}}},
    {"OrbitInMetres",
     15,
     "camera_motion: {kind: kepler, kepler: {semi_major_axis_km: 7000000, true_anomaly_deg: 0}}",
     "",
     "camera_motion.kepler.semi_major_axis_km is 7000000: that is 0.047 au from the body 'earth'; in metres?",
     {{16, ""}, {17, ""}, {18, ""}, {19, ""}}},
    {"EveryWithoutAStart", 24, "events: [{every_s: 5, do: ping}]", "24:10",
     "events.0: an event has one of 'at_s', 'at_utc', 'at_frame', 'after'"},
    {"LookAtWithoutUnit", 18, "  look_at: [0, 0, 0]", "18:3",
     "camera_pose.look_at: unknown key; nearest known key: look_at_m"},
    {"EulerWithoutSequence",
     17,
     "  attitude_euler_deg: [90, 0, 0]",
     "17:23",
     "camera_pose.attitude_euler_deg: has no 'euler_sequence'; accepted:",
     {{18, ""}, {19, ""}}},
    {"FolderForAMesh", 22, "    mesh: .", "22:11", "found a file of kind ''; accepted: .glb .gltf .obj"},
    {"EmptyMesh", 22, "    mesh: empty.obj", "22:11", "does not parse: OBJ-file is too small"},
    {"DateOfTheCountry", 2, "time_utc: 20/03/2026", "2:11",
     "time_utc: time '20/03/2026' is not a date and time; accepted: UTC as"},
    {"YearWithASlip", 2, "time_utc: 2206-03-20T12:00:00Z", "2:11",
     "time_utc: time '2206-03-20T12:00:00Z' is out of range; accepted: UTC"},
    {"Sensitivity0", 10, "  quantum_efficiency: 0", "", "the camera sees no light"},
    {"ObjectWithoutMesh", 22, "", "21:5",
     "objects.0: an object has either 'mesh' or 'generate'; found neither"},
    {"FolderForASection", 25, "outputs: {files: frames}", "25:18",
     "outputs.files: found 'frames'; accepted: a mapping, or the path of a file that holds it"},
    {"OutputMisspelt", 25, "outputs: {file: {folder: frames}}", "25:11",
     "outputs.file: unknown key; nearest known key: files"},
    {"PortTooLarge", 25, "outputs: {preview: {port: 80800}}", "25:27",
     "outputs.preview.port: found '80800'; accepted: a whole number, 1 to"},
    {"LocalhostByName", 25, "outputs: {preview: {address: localhost}}", "25:30",
     "outputs.preview.address: found 'localhost';"},
    {"PortForASection", 24, "commands: {udp: 5010}", "24:17",
     "commands.udp: found '5010'; accepted: a mapping, or the path of a file that holds it"},
    {"OthersAddress", 25, "outputs: {gige: {interface: 10.1.2.3}}", "",
     "interface '10.1.2.3' does not exist"},
    {"AfterNothing", 24, "events: [{after: start, do: expose}]", "24:10", "after: there is no event 'start'"},
    {"RateInPercent", 24, "faults: [{kind: image_black, rate: 5}]", "24:36",
     "faults.0.rate: found '5'; accepted: a number, 0 to 1"},
    {"KeyframesBackwards", 23,
     "    motion: {kind: keyframes, keyframes: [{at_s: 5, position_m: [0, 0, 0]}, {at_s: 1, position_m: [1, "
     "0, 0]}]}",
     "23:13", "motion of 'plate': keyframes: times do not rise at number 2"},
    {"NoTle", 23, "    motion: {kind: tle, tle: {file: none.tle}}", "23:13",
     "no such file; accepted: a file of element sets (TLE or OMM)"},
    {"CatalogueOfAnotherKind", 24, "stars: {catalogue: table.csv}", "24:20",
     "found 'a,b'; accepted: the names of the columns"},
    {"SeedByWord", 24, "seed: random", "24:7", "seed: found 'random'; accepted: a whole number, 0 to 9e+15"},
    {"BinsInTheDark", 24, "spectrum_edges_um: [0.2, 0.25]", "24:20",
     "spectrum_edges_um: the solar spectrum begins at 0.28 um; found"},
    {"TwiceAtOnePlace", 23,
     "    pose: {position_m: [0, 0, 0]}\n  - {name: again, mesh: plate.obj, pose: {position_m: [0, 0, 0]}}",
     "", "object 'again' has the mesh and the pose of 'plate'"},
    {"NoCameraPose",
     15,
     "",
     "",
     "nothing that is lit is in the picture: it will be black",
     {{16, ""}, {17, ""}, {18, ""}, {19, ""}}},
    {"NoAttitude",
     17,
     "",
     "",
     "object 'plate' is outside the field: 90.00 deg off the boresight",
     {{18, ""}, {19, ""}}},
    {"SamplesAsPercent", 24, "quality: {samples_per_axis: 100}", "24:29",
     "quality.samples_per_axis: found '100'; accepted: a whole number, 1 to"},
    {"TimeStands", 24, "clock: {scale: 0}", "24:16",
     "clock.scale: found '0'; accepted: a number, 0.001 to 1000"},
    {"NameWithoutANumber", 25, "outputs: {files: {folder: frames, name: frame.png}}", "25:18",
     "outputs.files: name: found 'frame.png'; each frame would be written"},
    {"LayerMisspelt", 25, "outputs: {truth: {folder: t, layers: [depht]}}", "25:18",
     "outputs.truth: layers: found 'depht'; accepted: object, range, depth,"},
    {"TruthToNobody", 25, "outputs: {truth: {visibility: true}}", "25:18",
     "outputs.truth: outputs.truth goes nowhere; accepted: one of port,"},
    {"Backslashes", 22, "    mesh: \"C:\\models\\plate.obj\"", "22:16",
     "not YAML: unknown escape character: m"},
    {"CommaInANumber", 8, "  focal_length_mm: 6,4", "8:20",
     "camera.focal_length_mm: found '6,4'; accepted: a number, 0.1 to 100000"},
    {"Kelvin", 14, "  bits: 12\n  temperature_c: 293", "15:18",
     "camera.temperature_c: found '293'; accepted: a number, -200 to 150"},
    {"ReadNoiseAboveTheWell", 14, "  bits: 12\n  read_noise_e: 9000\n  offset_dn: 500", "",
     "object 'plate' is lost in the noise"},
    {"RowsThatTakeAnHour", 14, "  bits: 12\n  shutter: {kind: rolling, line_time_us: 1000000}", "",
     "with the shutter's rows allows 0.01562 frames/s at most"},
    {"LocalWithoutASite",
     3,
     "origin: {kind: earth_center}",
     "23:19",
     "objects.0.pose.frame: found 'local', and no site for its axes;",
     {{23, "    pose: {frame: local, position_m: [0, 0, 0]}"}}},
    {"AlbedoMissing", 23, "    albedo_file: none.tab", "23:18", "no such file; accepted: a table of albedos"},
    {"ScaleNegative", 22, "    mesh: plate.obj\n    scale: -1", "23:12",
     "objects.0.scale: found '-1'; accepted: a number, 1e-06 to 1000000"},
    {"InsideTheEarth", 23, "    pose: {position_m: [-40000000, 0, 0]}", "",
     "object 'plate' is inside the body 'earth', 2723.23 km from its centre"},
    {"LampWithoutLight", 24, "lamps: [{name: a, intensity_w_sr_um: 0}]", "",
     "lamp 'a' is lit and gives no light"},
    {"PositionAsMapping", 16, "  position_m: {x: 4, y: 0, z: 0}", "16:15",
     "camera_pose.position_m: found a mapping; accepted: a list of 3 numbers"},
    {"Capitals", 24, "Mode: free_run", "24:1", "Mode: unknown key; nearest known key: mode"},
    {"FilesFolderAFile", 25, "outputs: {files: {folder: plate.obj}}", "", "outputs.files.folder: found '"},
    {"TimeNoZone", 2, "time_utc: 2026-03-20 12:00", "2:11",
     "time_utc: time '2026-03-20 12:00' is not a date and time; accepted:"},
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

constexpr const char* kPlate =
    "v 0 -0.05 -0.05\nv 0 0.05 -0.05\nv 0 0.05 0.05\nv 0 -0.05 0.05\nf 1 2 3\nf 1 3 4\n";

std::string with(const Mistake& mistake) {
    std::map<int, std::string> edits(mistake.others.begin(), mistake.others.end());
    edits[mistake.line] = mistake.text;
    std::istringstream in(kScenario);
    std::string text, line;
    for (int number = 1; std::getline(in, line); ++number)
        text += (edits.contains(number) ? edits[number] : line) + "\n";
    return text;
}

class ScenarioMistakes : public FilesTest, public testing::WithParamInterface<Mistake> {};

TEST_P(ScenarioMistakes, AreTold) {
    const Mistake& mistake = GetParam();
    const std::string plate = kPlate;
    write("plate.obj", plate);
    write("grey.obj", "mtllib grey.mtl\n" + plate);
    write("inside.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
    write("empty.obj", "");
    write("table.csv", "a,b\n1,2\n");
    const auto file = write("scenario.yaml", with(mistake));
    CheckReport report;
    const std::string error = error_of([&] { report = check_scenario(load_scenario(file, {})); });
    if (*mistake.place) {
        EXPECT_THAT(error, testing::StartsWith(file.string() + ":" + mistake.place + ": "));
        EXPECT_THAT(error, testing::HasSubstr(mistake.words));
    } else {
        EXPECT_EQ(error, "no error");
        EXPECT_THAT(report.warnings, testing::Contains(testing::HasSubstr(mistake.words)));
        EXPECT_THAT(report.warnings, testing::Each(testing::StartsWith(file.string())));
    }
}

INSTANTIATE_TEST_SUITE_P(All, ScenarioMistakes, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return std::string(mistake.param.name); });

// A value that is right by itself and wrong in its place is the command line's, wherever the section's file is.
TEST_F(FilesTest, AMistakeOfTheCommandLineIsNamedByIt) {
    write("plate.obj", "v 0 -0.05 -0.05\nv 0 0.05 -0.05\nv 0 0.05 0.05\nf 1 2 3\n");
    const auto file = write("scenario.yaml", kScenario);
    const auto error = [&](const std::string& set) {
        return error_of([&] { check_scenario(load_scenario(file, {{set}})); });
    };
    EXPECT_THAT(error("camera.window_px=[60, 0, 10, 10]"),
                testing::StartsWith("--set camera.window_px: reaches outside the sensor of 64 x 64"));
    EXPECT_THAT(error("camera.window_px=[0.5, 0, 10, 10]"),
                testing::StartsWith("--set camera.window_px: found 0.5; accepted: whole pixels"));
    EXPECT_THAT(error("camera.offset_dn=5000"), testing::StartsWith("--set camera.offset_dn: 5000 leaves"));
    EXPECT_THAT(error("stars.catalogue=none.csv"), testing::StartsWith("--set stars.catalogue: "));
}

// What concerns a run alone is no picture's, and frames for nobody are a run's affair.
TEST_F(FilesTest, APictureAndARunAreWarnedOfWhatConcernsThem) {
    using testing::Contains;
    using testing::HasSubstr;
    write("plate.obj", kPlate);
    const auto warnings = [&](VerdictOn on, const std::vector<std::string>& set) {
        return early_verdict(load_scenario(write("scenario.yaml", kScenario), set), on);
    };
    const std::vector<std::string> silent = {"outputs={}"}, nobody = {"mode=lockstep"},
                                   far = {"origin.height_km=35786000"};
    const auto none = HasSubstr("outputs: there are none, so the frames of a run go nowhere");
    EXPECT_THAT(warnings(VerdictOn::kRun, silent), Contains(none));
    EXPECT_THAT(warnings(VerdictOn::kPicture, silent), testing::IsEmpty());
    EXPECT_THAT(warnings(VerdictOn::kAll, silent), testing::IsEmpty());
    for (const VerdictOn on : {VerdictOn::kRun, VerdictOn::kAll})
        EXPECT_THAT(warnings(on, nobody), Contains(HasSubstr("nothing can request a frame")));
    EXPECT_THAT(warnings(VerdictOn::kPicture, nobody), testing::IsEmpty());
    for (const VerdictOn on : {VerdictOn::kRun, VerdictOn::kPicture, VerdictOn::kAll})
        EXPECT_THAT(warnings(on, far),
                    Contains(HasSubstr("--set origin.height_km: origin.height_km is 35786000")));
}

class ScenarioWithoutMistakes : public FilesTest {};
TEST_F(ScenarioWithoutMistakes, NothingIsToldOfIt) {
    write("plate.obj", "v 0 -0.05 -0.05\nv 0 0.05 -0.05\nv 0 0.05 0.05\nv 0 -0.05 0.05\nf 1 2 3\nf 1 3 4\n");
    const auto file = write("scenario.yaml", kScenario);
    EXPECT_THAT(check_scenario(load_scenario(file, {})).warnings, testing::IsEmpty());
}

// A key that is renamed to one that there is not would send its reader astray, and so would a new key of an old name.
TEST(Scenario, EarlierNamesAreKeysOfTodayByTheirNewOnesAlone) {
    ScenarioConfig scenario;
    std::set<std::string, std::less<>> today;
    for (const std::string& key : config_keys(fields(scenario))) today.insert(key.substr(key.rfind('.') + 1));
    for (const char* was : {"kept_directions", "kept_nodes", "kept_step_deg", "kept_earth",
                            "point_samples_least", "most_triangles", "least_hz", "most_hz"}) {
        EXPECT_TRUE(today.contains(renamed_key(was))) << was;
        EXPECT_FALSE(today.contains(was)) << was;
    }
    for (const char* was : {"noise_budget", "max_passes", "most_passes"}) {
        EXPECT_TRUE(today.contains(removed_key(was)->beside)) << was;
        EXPECT_FALSE(today.contains(was)) << was;
    }
}

TEST(Scenario, ARecordingOfEarlierNamesIsRead) {
    EXPECT_EQ(listing_difference("quality.kept_nodes = 5\nquality.path_model = kept\n",
                                 "quality.path_model = cached\nquality.probes = 5\n"),
              "");
    EXPECT_NE(listing_difference("quality.kept_nodes = 5\n", "quality.probes = 6\n"), "");
    // What changed no frame is no difference.
    EXPECT_EQ(
        listing_difference("quality.max_passes = 16\nquality.noise_budget = 0\nseed = 1\n", "seed = 1\n"),
        "");
    EXPECT_EQ(listing_difference("quality.noise_budget = 0.3\n", ""),
              "quality.noise_budget: '0.3' there, '(no such key)' here");
}

}  // namespace
}  // namespace hilcam
