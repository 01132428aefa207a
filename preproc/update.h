// Update: changes what a dataset is made of, and makes anew only the pages that this touches: those that hold posts or
// texels where a source comes, goes or has changed, and the pages above them.
//
// The dataset has the same pages as if it had been built of the sources that it then has. It changes in one step
// (change_writer.h); where a source cannot be read it stays as it was.
//
// Threads: blocks the caller; uses `jobs` workers and one writer.
#pragma once

#include "preproc/build.h"
#include "preproc/spec.h"
#include "runtime/base/clock.h"
#include "runtime/base/status.h"

#include <functional>

namespace belvedere {

// What the dataset is to be made of, from what it is made of.
using SpecChange = std::function<Result<BuildSpec>(BuildSpec)>;

// options.out is the dataset. All its sources, and new ones, must be there to be opened. A source whose files have
// changed is read anew whatever the change is.
Result<BuildReport> Update(const SpecChange& change, const BuildOptions& options, const Clock& clock);

}  // namespace belvedere
