// Reads frames of a V4L2 device with OpenCV, as they are, into a file.    opencv_reader DEVICE FRAMES FILE
#include <cstdio>
#include <cstdlib>
#include <opencv2/videoio.hpp>

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    cv::VideoCapture capture(argv[1], cv::CAP_V4L2);
    if (!capture.isOpened()) return std::fprintf(stderr, "opencv: %s does not open\n", argv[1]), 1;
    capture.set(cv::CAP_PROP_CONVERT_RGB, 0);
    std::FILE* file = std::fopen(argv[3], "wb");
    if (!file) return std::perror(argv[3]), 1;
    cv::Mat frame;
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
        if (!capture.read(frame)) return std::fprintf(stderr, "opencv: frame %d cannot be read\n", i), 1;
        std::fwrite(frame.data, frame.elemSize(), frame.total(), file);
    }
    std::fprintf(stderr, "opencv: %d x %d, %d channels of %zu bytes\n", frame.cols, frame.rows,
                 frame.channels(), frame.elemSize1());
    return std::fclose(file) == 0 ? 0 : 1;
}
