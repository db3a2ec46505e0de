// Said on the form and on the result, so that nobody takes an estimate for a mark.
export const stitchHint = "Mark the finished work as you see it in the replay. The simulator's estimates appear when your marks are stored; giving marks again replaces yours.";
