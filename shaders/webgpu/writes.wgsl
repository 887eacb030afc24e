// The kernels that write the history: Flip, the tail, the counts, and the preparation.
#import census
#import count_areas
#import embedded if plane
#import iteration
#import prepare_creases if space
