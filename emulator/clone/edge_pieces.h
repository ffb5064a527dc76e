#pragma once
// Finds one slanted edge that crosses a picture, cuts it into pieces along its length, and measures the MTF
// of each (sensor/measure/slanted_edge.h). An edge from the middle to a side so shows several image heights.
//
// The uncertainty is by resampling: each piece is measured again without each sixteenth of its rows
// (delete-one jackknife; Efron and Tibshirani, An Introduction to the Bootstrap, 1993, ch. 11), which has
// noise, the pixels' own differences, and an edge that is not quite straight.

#include <string>
#include <vector>

#include "render/vocabulary/vec.h"
#include "sensor/measure/slanted_edge.h"

namespace hilcam {

struct EdgePiece {
    Vec2d place_px;                            // middle of the piece on the picture
    EdgeMtf mtf;                               // MTF, with the jackknife's uncertainty
    std::vector<std::vector<double>> without;  // MTF curve without each block
};
// Returns the standard deviation of a figure from its values without each block.
double jackknife_uncertainty(const std::vector<double>& without);

// name: for messages. Throws InputError, one line, for a picture without one straight edge that is slanted by
// 1 to 40 degrees against rows or columns. Owner thread.
std::vector<EdgePiece> measure_edge_pieces(const EdgePicture& picture, const std::string& name);

}  // namespace hilcam
