// The kernels that write the history: those of Flip, of the tail, of the census, and of what comes before the first iteration.
#import census
#import embedded if plane
#import iteration
#import prepare_creases if space
