// The kernels that write the history: Flip, the tail, the census, and the preparation.
#import census
#import embedded if plane
#import iteration
#import prepare_creases if space
