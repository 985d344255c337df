"""The sandbox: where a program that a model wrote runs, so that nothing but its one channel leads out.

    server = WarmServer(path=[folder], preload=["runner"])     chatrobot.sandbox.warm_server
    server.start()
    process = server.launch("runner:main", payload)            chatrobot.sandbox.process
    process.channel.recv(4096)

`probe` in chatrobot.sandbox.warm_server says which walls stand on this machine.
"""
