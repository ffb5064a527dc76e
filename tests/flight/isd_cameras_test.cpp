// hilcam's camera, lens and attitude against deep-space cameras as the USGS has them. OSIRIS-REx's TagCams have
// points of Bennu that ISIS publishes (UnitTestOsirisRexTagCams.cpp, with the geometry in the cubes of its
// tests, isis/tests/data/osirisRexImages). For Cassini's, New Horizons', ExoMars' and OSIRIS-REx's others there
// are camera descriptions alone (DOI-USGS/ale, tests/pytests/data/isds): their points are what USGSCSM 2.0.2
// (DOI-USGS/usgscsm, commit ba32d13, built outside of this tree) printed of them, from groundToImage() of what
// imageToGround() gave, to 1e-9 px. Places in the picture are pixels from its corner, as hilcam's are.

#include <gtest/gtest.h>

#include <array>
#include <span>

#include "tests/flight/published_view.h"

namespace hilcam {
namespace {

// How the picture's axes lie in the camera's: lines run along y, or against it.
enum class Lines { kAlongY, kAgainstY };

struct SeenPoint {
    double line_px, sample_px;
    Vec3d ground_body_m;
};

void expect_places(const PublishedView& view, Lines lines, std::span<const SeenPoint> points) {
    for (const SeenPoint& seen : points) {
        ASSERT_GT(view.direction_camera(seen.ground_body_m).z, 0);
        const Vec2d place = view.place_px(seen.ground_body_m);
        const double line = lines == Lines::kAlongY ? place.y : view.geometry.height_px - place.y;
        EXPECT_NEAR(place.x, seen.sample_px, kTarget_px) << seen.sample_px << ' ' << seen.line_px;
        EXPECT_NEAR(line, seen.line_px, kTarget_px) << seen.sample_px << ' ' << seen.line_px;
    }
}

// A TagCam of 2592 x 1944 px, reduced to 259 x 194 in the cube, and what its kernel has of the lens: OpenCV's
// terms, focal lengths across and down at 0 C, the middle (from 1 at the middle of the first pixel), and what
// the focal length gains by temperature. Lines run against y. hilcam's focal length is one; what they differ
// is a term of the polynomial, which is added to the ideal place and not to that by OpenCV's terms.
struct TagCam {
    double k1, k2, k3, p1, p2;
    Vec2d focal_length_px, middle;
    double growth_per_k, temperature_c;

    ImageGeometry geometry() const {
        constexpr int kWidth_px = 2592, kHeight_px = 1944;
        ImageGeometry out =
            pinhole(kWidth_px, kHeight_px, focal_length_px.x * (1 + growth_per_k * temperature_c));
        out.principal_offset_px = {middle.x - 0.5 - 0.5 * kWidth_px, 0.5 * kHeight_px - (middle.y - 0.5)};
        out.distortion.k1 = k1, out.distortion.k2 = k2, out.distortion.k3 = k3;
        out.distortion.p1 = -p1, out.distortion.p2 = p2;
        out.distortion.polynomial.order = 1;
        out.distortion.polynomial.y[2] = focal_length_px.y / focal_length_px.x - 1;
        return out;
    }
};

struct ReducedPoint {
    double sample, line, latitude_deg, longitude_deg;
};

void expect_bennu(const PublishedView& view, std::span<const ReducedPoint> points) {
    constexpr Vec3d kBennu_m{283.065, 271.215, 249.72};
    for (const ReducedPoint& seen : points) {
        const SeenPoint point{(seen.line - 0.5) * 1944 / 194, (seen.sample - 0.5) * 2592 / 259,
                              on_ellipsoid(kBennu_m, seen.latitude_deg, seen.longitude_deg)};
        expect_places(view, Lines::kAgainstY, {&point, 1});
    }
}

TEST(PublishedCameras, NavcamOnOsirisRexSeesBennuWhereIsisHasIt) {
    PublishedView view;
    view.geometry =
        TagCam{
            -0.53766,   0.37526,  -0.18368, 2.3432e-04, 9.0875e-04, {3473.26, 3473.321}, {1269.083, 950.747},
            2.2933e-05, -28.89233}
            .geometry();
    const Mat3d camera_from_spacecraft{{0.34268937097307, -0.93883069379178, -0.034072326256535},
                                       {0.93368902815614, 0.344374248416, -0.098138553732778},
                                       {0.10386911823504, 0.0018180820574099, 0.9945893126586}};
    const Quat spacecraft_from_icrf{5.654280425773024e-05, -0.21515754784565735, 0.08369418469168145,
                                    -0.9729863872926228};
    view.camera = {{-182.32489412919725, 32.823061553302633, -432.75811196133135},
                   from_dcm(camera_from_spacecraft * to_matrix(spacecraft_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{0.19030638094296595, 0.6659891181407347, -0.7007521897019551, -0.17084596722905848});
    constexpr std::array<ReducedPoint, 5> kSeen{{{129.5, 97, 49.7487786981275, 43.7549667753273},
                                                 {1, 1, 18.614472228664749, 30.4388285538537},
                                                 {259, 1, 36.692323846663946, 81.774178147101267},
                                                 {1, 194, 44.70914449416866, 1.6058653718226457},
                                                 {259, 194, 71.210706457717208, 82.189907756214126}}};
    expect_bennu(view, kSeen);
}

TEST(PublishedCameras, NftcamOnOsirisRexSeesBennuWhereIsisHasIt) {
    PublishedView view;
    view.geometry =
        TagCam{-0.53831,           0.38214,    -0.20281, -6.2239e-04, -1.2388e-04, {3462.53, 3462.532},
               {1310.53, 969.487}, 1.9876e-05, -21.04614}
            .geometry();
    const Mat3d camera_from_spacecraft{{0.28925405437698, -0.95446105019713, 0.073049268874342},
                                       {0.92576782261732, 0.29833522922608, 0.23227145672469},
                                       {-0.24348722889069, 4.41202015923513e-04, 0.96990400283116}};
    const Quat spacecraft_from_icrf{0.8452345342850801, -0.13899461515299796, 0.4752756250962329,
                                    -0.20092824390746747};
    view.camera = {{149.70240175798732, 155.8347452196846, -146.0893236426393},
                   from_dcm(camera_from_spacecraft * to_matrix(spacecraft_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{0.19844279558203384, 0.7960695700959617, 0.5485147002781138, 0.16132364993276374});
    constexpr std::array<ReducedPoint, 5> kSeen{{{129.5, 97, 53.7314045659365, 45.4736806050086},
                                                 {1, 1, 53.74996008837919, 44.87991851142592},
                                                 {259, 1, 53.45070519515528, 45.595734037697831},
                                                 {1, 194, 54.251546951663194, 45.249110941406045},
                                                 {259, 194, 53.714109526681277, 46.006871961761462}}};
    expect_bennu(view, kSeen);
}

// ISS NAC on Cassini at Enceladus, 11 December 2011 (cassiniiss_isd.json): 2003.09 mm, 12 um, ideal radius
// r (1 + 8e-6 r^2 / mm^2), whose inverse is d = r (1 - c r^2 + 3 c^2 r^4 - 12 c^3 r^6 ...).
TEST(PublishedCameras, CassinisNarrowAngleCameraSeesEnceladusWhereUsgscsmHasIt) {
    constexpr double kFocal_mm = 2003.09, kDistortion_mm2 = 8e-6;
    const double c = kDistortion_mm2 * kFocal_mm * kFocal_mm;
    PublishedView view;
    view.geometry = pinhole(1024, 1024, kFocal_mm / 0.012);
    view.geometry.distortion.k1 = -c, view.geometry.distortion.k2 = 3 * c * c;
    view.geometry.distortion.k3 = -12 * c * c * c;
    const Mat3d camera_from_spacecraft{{-0.0014870197280318354, -0.00017182872562465645, 0.9999988796229811},
                                       {-0.9999987285211891, -0.0005757037366556639, -0.0014871184258905545},
                                       {0.0005759586213144874, -0.999999819520032, -0.00017097242433417037}};
    const Quat spacecraft_from_icrf{-0.714592970784935, 0.21489250965350096, 0.44184670438419815,
                                    -0.4979453636940545};
    view.camera = {{21961772.83021467, 10151980.187116338, -3287133.9343305876},
                   from_dcm(camera_from_spacecraft * to_matrix(spacecraft_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{-0.49726210411698374, 0.01884225276113552, 0.0532896313700967, 0.8657572318545625});
    const std::array<SeenPoint, 5> seen{{{0, 0, {122103.320681, -155587.777392, -158195.238682}},
                                         {0, 1024, {-15672.8705221, -240017.319614, -86493.3637922}},
                                         {512, 512, {86634.3098586, -233846.906359, -58490.5042588}},
                                         {1024, 0, {195614.749456, -163374.346123, -28823.3040274}},
                                         {1024, 1024, {57691.1469499, -246157.135988, 42422.062954}}}};
    expect_places(view, Lines::kAlongY, seen);
}

// LORRI on New Horizons, Io, 28 February 2007 (nhlorri_isd.json, without a lens; its middle, which is left out
// there, at 512). LORRI looks along -z: x here is its -x.
TEST(PublishedCameras, LorriSeesIoWhereUsgscsmHasIt) {
    PublishedView view;
    view.geometry = pinhole(1024, 1024, 2618.4775964615383 * 76.923076923077);
    const Mat3d camera_from_spacecraft{{0.005452680629036, 0.99996036726125, -0.007037910250677},
                                       {0.002999533810427, -0.0070543385533461, -0.99997061912063},
                                       {-0.99998063534794, 0.0054314099747325, -0.0030378799858676}};
    const Quat spacecraft_from_icrf{-0.040223695171375, 0.062038072129285, 0.97695635330468,
                                    0.20022391388359};
    view.camera = {{-2390849002.579, 321807337.61069, -141054737.89822},
                   from_dcm(camera_from_spacecraft * to_matrix(spacecraft_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{-0.57817095054415, 0.13699803004374, 0.1729987472005, -0.78550704973162});
    const std::array<SeenPoint, 5> seen{{{0, 0, {6470479.81836, 559990.108883, 7367375.13574}},
                                         {0, 1024, {-5565999.4322, -1871533.66826, 7000747.50936}},
                                         {512, 512, {229495.177975, 1346015.86321, 1208370.72297}},
                                         {1024, 0, {6591433.56635, 1804309.4812, -4854014.68443}},
                                         {1024, 1024, {-5445149.6439, -627290.777051, -5220667.44914}}}};
    expect_places(view, Lines::kAgainstY, seen);
}

// CaSSIS on the Trace Gas Orbiter, Mars, 26 November 2016 (cassis_isd.json, without a lens; all of its 2048
// lines, one pixel a sum, which is written as 0 there).
TEST(PublishedCameras, CassisSeesMarsWhereUsgscsmHasIt) {
    PublishedView view;
    view.geometry = pinhole(2048, 2048, 874.9 * 100);
    view.geometry.principal_offset_px = {0.5, 0.5};
    const Mat3d camera_from_telescope{{0.0021039880161896, -0.000508910327554815, 0.99999765711961},
                                      {0.98482103650022, 0.17356149021485, -0.0019837290716917},
                                      {-0.17356007404082, 0.98482290292452, 0.000866356891752243}};
    const Quat telescope_from_icrf{-0.38852078202718, -0.53534661398878, -0.74986993015978,
                                   0.012275694110544};
    view.camera = {{-2707026.6303122, 2307373.459613, 2074888.7762465},
                   from_dcm(camera_from_telescope * to_matrix(telescope_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{-0.84364286886959, 0.083472339272581, 0.30718999789287, -0.43235793455935});
    const std::array<SeenPoint, 5> seen{{{0, 0, {-3311843.40733, 214723.621525, -716654.514074}},
                                         {0, 2048, {-3302256.03753, 234304.496228, -753373.783553}},
                                         {1024, 1024, {-3302659.12893, 266138.313397, -741078.204952}},
                                         {2048, 0, {-3302580.49102, 300071.69094, -728506.917321}},
                                         {2048, 2048, {-3291152.56579, 324676.341083, -768114.113406}}}};
    expect_places(view, Lines::kAlongY, seen);
}

// MapCam on OSIRIS-REx, Bennu, 3 March 2019 (osirisrex_isd.json, without a lens: USGSCSM's law of radius has
// another form than these terms). Its samples run along y, its lines along x; x here is its y.
TEST(PublishedCameras, MapcamOnOsirisRexSeesBennuWhereUsgscsmHasIt) {
    PublishedView view;
    view.geometry = pinhole(1024, 1024, 125.2 * 117.64705882353);
    view.geometry.principal_offset_px = {-0.5, 0.5};
    const Mat3d turned{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    const Quat camera_from_icrf{0.4945916645160911, -0.4620797005791134, 0.36450726891518725,
                                0.6395278622639601};
    view.camera = {{6263.896259086776, -177.89034115912727, -2051.6825743917164},
                   from_dcm(turned * to_matrix(camera_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{-0.24468662154888665, -0.8995476917306681, 0.3540944064834505, 0.07456244922312974});
    const std::array<SeenPoint, 5> seen{{{0, 0, {-63.8084092281, -1.60672726961, 243.288518911}},
                                         {0, 1024, {42.6074995228, -225.649091855, -146.011149593}},
                                         {512, 512, {276.296940966, -40.8647177786, 40.579957655}},
                                         {1024, 0, {197.344526114, 350.002543864, 111.807410214}},
                                         {1024, 1024, {263.781467671, 146.025899599, -292.591261621}}}};
    expect_places(view, Lines::kAgainstY, seen);
}

}  // namespace
}  // namespace hilcam
