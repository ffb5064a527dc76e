#pragma once
// Heights on a regular grid of any size, read point by point, so that only what is needed has to be in
// memory.

namespace hilcam {

class HeightMap {
  public:
    virtual ~HeightMap() = default;
    virtual int columns() const = 0;  // at least 2
    virtual int rows() const = 0;     // at least 2; row 0 is the northernmost
    virtual double spacing_m() const = 0;
    // Returns a finite value. 0 <= column < columns(), 0 <= row < rows(). Any thread.
    virtual float height_m(int column, int row) const = 0;
};

}  // namespace hilcam
